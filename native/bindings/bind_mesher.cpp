#include <optional>
#include <tuple>
#include <utility>
#include <variant>

#include "bindings/one_caller.hpp"
#include "bindings/results.hpp"
#include "bindings/shared_volume.hpp"
#include "geom/math.hpp"
#include "marching/patch_edges.hpp"
#include "riffler/marching/mesher.hpp"

namespace riffler::bindings {

namespace {

struct SharedMesher : Guarded {
  SharedMesher(marching::Mesher m, const std::optional<double>& t) : mesher(std::move(m)), tolerance(t) {}
  marching::Mesher mesher;
  std::optional<double> tolerance;  // as given
  marching::PickStats stats;        // since the last take_counters; under the GIL
};

struct SharedSurface {
  marching::FrozenSurface surface;
  marching::PickStats stats;  // since the last take_counters; under the GIL
};

/// Held through every call.
OneCaller lock(SharedMesher& m) {
  return {m, "the mesher"};
}

Volume state_of(SharedVolume& volume) {
  return Reading(volume).volume.snapshot();
}

std::unique_ptr<SharedMesher> make_mesher(SharedVolume& volume, const std::optional<double>& tolerance,
                                          const ProgressLike& callable) {
  const Progress progress = to_progress(callable);
  const Volume state = state_of(volume);
  const NoGil release;
  return std::make_unique<SharedMesher>(
      tolerance ? marching::Mesher(state, *tolerance, progress) : marching::Mesher(state, progress), tolerance);
}

using BrickOrBricks = std::variant<std::size_t, std::vector<std::size_t>>;

PatchResult patch(SharedMesher& self, const BrickOrBricks& bricks, bool with_edges,
                  const std::optional<double>& sharp) {
  if (sharp && !(*sharp >= 0 && *sharp <= kPi)) throw std::invalid_argument("normals: the angle must be 0 to pi rad");
  marching::MeshPatch patch;
  marching::PatchEdges edges;
  base::BulkVector<Vec3f> normals;
  {
    const NoGil release;
    const auto held = lock(self);
    const auto* const one = std::get_if<std::size_t>(&bricks);
    patch = one ? self.mesher.patch(*one) : self.mesher.patch(std::get<std::vector<std::size_t>>(bricks));
    if (with_edges) edges = edges_of(patch);
    if (sharp) normals = self.mesher.corner_normals(patch, *sharp);
  }
  using namespace py::literals;
  py::dict out("vertices"_a = take<float>(std::move(patch.vertices), 3),
               "triangles"_a = take<std::int32_t>(std::move(patch.triangles), 3));
  if (with_edges) {
    out["edges"] = take<std::int32_t>(std::move(edges.vertices), 2);
    out["corner_edges"] = take<std::int32_t>(std::move(edges.of_corner), 3);
  }
  if (sharp) out["normals"] = take<float>(std::move(normals), 3);
  return make_result("Patch", out);
}

using Hits = std::vector<std::optional<marching::SurfaceHit>>;

py::object from_hit(const std::optional<marching::SurfaceHit>& hit) {
  if (!hit) return py::none();
  using namespace py::literals;
  return make_result("Hit", py::dict("distance"_a = hit->distance, "point"_a = from_vec3(hit->point),
                                     "normal"_a = from_vec3(hit->normal), "brick"_a = hit->brick));
}

py::object from_hits(const Hits& hits) {
  using namespace py::literals;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const marching::SurfaceHit nothing{std::numeric_limits<double>::infinity(), Vec3(kNone), Vec3(kNone), 0};
  std::vector<double> distances;
  std::vector<Vec3> points, normals;
  std::vector<std::int64_t> bricks;
  for (const std::optional<marching::SurfaceHit>& found : hits) {
    const marching::SurfaceHit& hit = found ? *found : nothing;
    distances.push_back(hit.distance), points.push_back(hit.point), normals.push_back(hit.normal);
    bricks.push_back(found ? static_cast<std::int64_t>(hit.brick) : -1);
  }
  return make_result("Hits",
                     py::dict("distance"_a = take<double>(std::move(distances)), "point"_a = from_vec3s(points),
                              "normal"_a = from_vec3s(normals), "brick"_a = take<std::int64_t>(std::move(bricks))));
}

void add(marching::PickStats& sum, const marching::PickStats& s) {
  sum.rays += s.rays, sum.bricks_visited += s.bricks_visited, sum.bricks_prepared += s.bricks_prepared;
  sum.triangles_tested += s.triangles_tested;
}

/// One ray, or one a row: `hits_of(origins, directions, stats)` is called without the GIL.
template <class HitsOf>
py::object pick(const Doubles& origin, const Doubles& direction, marching::PickStats& sum, HitsOf&& hits_of) {
  const bool one = origin.ndim() == 1;
  const auto rows = [&](const Doubles& array, const char* name) {
    return one ? std::vector<Vec3>{to_vec3(array, name)} : to_vec3s(array, name);
  };
  const std::vector<Vec3> origins = rows(origin, "origin"), directions = rows(direction, "direction");
  if (origins.size() != directions.size())
    throw py::value_error("direction must have as many rows as origin, " + std::to_string(origins.size()) + ", not " +
                          std::to_string(directions.size()));
  for (std::size_t n = 0; n < directions.size(); ++n)
    if (directions[n] == Vec3(0))
      throw py::value_error(one ? "direction: zero" : "direction, row " + std::to_string(n) + ": zero");
  marching::PickStats stats;
  const Hits hits = [&] {
    const NoGil release;
    return hits_of(origins, directions, stats);
  }();
  add(sum, stats);
  return one ? from_hit(hits[0]) : from_hits(hits);
}

template <class Pickable>
Hits hits_of(Pickable& surface, const std::vector<Vec3>& origins, const std::vector<Vec3>& directions,
             marching::PickStats& stats) {
  Hits hits;
  for (std::size_t n = 0; n < origins.size(); ++n) hits.push_back(surface.pick(origins[n], directions[n], stats));
  return hits;
}

PickResult pick_live(SharedMesher& self, const Doubles& origin, const Doubles& direction) {
  return pick(origin, direction, self.stats,
              [&](const auto& origins, const auto& directions, marching::PickStats& stats) {
                const auto held = lock(self);
                return hits_of(self.mesher, origins, directions, stats);
              });
}

PickResult pick_frozen(SharedSurface& self, const Doubles& origin, const Doubles& direction) {
  return pick(origin, direction, self.stats,
              [&](const auto& origins, const auto& directions, marching::PickStats& stats) {
                return hits_of(self.surface, origins, directions, stats);
              });
}

PickCountersResult result_of(const marching::PickStats& s) {
  using namespace py::literals;
  return make_result("PickCounters",
                     py::dict("rays"_a = s.rays, "bricks_visited"_a = s.bricks_visited,
                              "bricks_prepared"_a = s.bricks_prepared, "triangles_tested"_a = s.triangles_tested));
}

/// `counters` and `take_counters`, of a mesher or of a surface.
template <class Shared>
void bind_counters(py::class_<Shared>& bound) {
  bound.def_property_readonly(
      "counters", [](const Shared& self) { return result_of(self.stats); },
      "PickCounters: the work of picking since it was made, or since `take_counters`. Reading them changes nothing.");
  bound.def(
      "take_counters", [](Shared& self) { return result_of(std::exchange(self.stats, {})); },
      R"(The counters, which start again from 0.

Returns
-------
PickCounters
    The work since the last call.

Examples
--------
>>> mesher = riffler.Mesher(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
>>> hit = mesher.pick((10, 10, 20), (0, 0, -1))
>>> mesher.take_counters().rays, mesher.counters.rays
(1, 0)
)");
}

std::unique_ptr<SharedSurface> freeze(SharedMesher& self) {
  marching::PickStats stats;
  auto out = [&] {
    const NoGil release;
    const auto held = lock(self);
    return std::make_unique<SharedSurface>(SharedSurface{self.mesher.freeze(stats), {}});
  }();
  add(self.stats, stats);
  return out;
}

const char* const kPickText =
    R"(The first point of the surface along a ray, or along each of several.

No ray passes between two triangles, and a ray that touches an edge hits it.

Parameters
----------
origin : array_like of shape (3,) or (n, 3), mm
    Origin of each ray.
direction : array_like of the same shape, of any length but 0
    Direction of each ray.

Returns
-------
Hit, None or Hits
    For one ray a Hit, or None. For (n, 3) arrays a Hits with arrays of n rows: for a ray without a hit, ``distance`` is
    inf, ``brick`` -1, the rest NaN.

Raises
------
ValueError
    Names argument and row: a number that is not finite, or a direction of length 0.

Examples
--------
>>> mesher = riffler.Mesher(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
>>> hit = mesher.pick((10, 10, 20), (0, 0, -1))
>>> round(hit.distance, 3), hit.normal.round(3).tolist()
(10.0, [0.0, 0.0, 1.0])
)";

void bind_frozen_surface(py::module_& m) {
  py::class_<SharedSurface> surface(m, "FrozenSurface",
                                    "The surface of a mesher at the time of `Mesher.freeze`, to be picked; it never "
                                    "changes. See `Mesher.freeze`.");
  surface.def("pick", &pick_frozen, py::arg("origin"), py::arg("direction"), kPickText)
      .def_property_readonly(
          "triangles", [](const SharedSurface& self) { return self.surface.triangles(); }, "Number of triangles.")
      .def_property_readonly(
          "nbytes", [](const SharedSurface& self) { return self.surface.nbytes(); },
          "Bytes of its triangles, of which it shares those of bricks that did not change with the mesher.");
  bind_counters(surface);
}

std::vector<std::size_t> update(SharedMesher& self, SharedVolume& volume, bool normals) {
  const Volume state = state_of(volume);
  const NoGil release;
  const auto held = lock(self);
  return self.mesher.update(state, normals);
}

std::vector<std::size_t> patches(SharedMesher& self) {
  const auto held = lock(self);
  return self.mesher.patches();
}

std::tuple<int, int, int> shape(SharedMesher& self) {
  const auto held = lock(self);
  const Vec3i shape = self.mesher.shape();
  return {shape.x, shape.y, shape.z};
}

Mesh whole(SharedMesher& self) {
  const NoGil release;
  const auto held = lock(self);
  return self.mesher.mesh();
}

}  // namespace

void bind_mesher(py::module_& m) {
  bind_frozen_surface(m);
  py::class_<SharedMesher> mesher(m, "Mesher",
                                  R"(The mesh of a volume that keeps changing, in bricks of 32 × 32 × 32 cells.

``Mesher(volume)`` meshes the volume; ``update(volume)`` meshes only its changes. The mesh is
always, bit for bit, that of ``volume.to_mesh()``, with a tolerance that of ``volume.to_mesh(tolerance=tolerance)``.
It keeps a snapshot of the volume, which shares its tiles.

With a tolerance, patches and `mesh` have only the triangles that the shape needs. The mesher keeps the full mesh too,
for the next update: `pick` and `freeze` find the full surface, and ``patch(normals=...)`` takes its normals, so that a
long triangle is shaded like the small ones that it replaces. It takes about a third more memory than without a tolerance.

Parameters
----------
volume : Volume
    The volume to mesh first.
tolerance : float, mm, or None
    Leaves out triangles that the shape does not need within this distance, with the rules of `Volume.to_mesh`: 0, or
    less than the step of float32 at the part's coordinates, keeps all of them. None: all of them.
progress : callable or None
    Called with the finished share; returning False cancels.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
>>> mesher = riffler.Mesher(volume)
>>> cut = volume.carve(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
>>> changed = mesher.update(volume)
>>> len(mesher.mesh().triangles) == len(volume.to_mesh().triangles)
True
>>> riffler.Mesher(volume, tolerance=0.05).triangles < 0.1 * mesher.triangles
True

Raises
------
ValueError
    A tolerance that is negative or not finite.
)");
  mesher
      .def(py::init(&make_mesher), py::arg("volume"), py::kw_only(), py::arg("tolerance") = py::none(),
           py::arg("progress") = py::none())
      .def("update", &update, py::arg("volume"), py::kw_only(), py::arg("normals") = false,
           R"(Follows a change of the volume.

Parameters
----------
volume : Volume
    As it is now.
normals : bool
    Also return the bricks whose triangles are the same, but whose ``patch(normals=...)`` may have other normals, since
    they meet changed ones.

Returns
-------
list of int
    Numbers of the bricks whose patches changed, ascending.

Raises
------
ValueError
    A volume with another box, pitch or directions.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
>>> mesher = riffler.Mesher(volume)
>>> mesher.update(volume)
[]
)")
      .def("patches", &patches, R"(Numbers of the bricks that have triangles.

Returns
-------
list of int
    Ascending.

Examples
--------
>>> riffler.Mesher(riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)).patches()
[0]
)")
      .def_property_readonly("shape", &shape,
                             "Number of bricks along each axis, with or without triangles: brick n is at "
                             "``numpy.unravel_index(n, shape)``.")
      .def("patch", &patch, py::arg("bricks"), py::kw_only(), py::arg("edges") = false, py::arg("normals") = py::none(),
           R"(The triangles of a brick, or of several without seams between them.

The brick's own vertices come first, then those of its neighbours that its triangles touch; what two patches share has
the same coordinates in both, bit for bit. With a tolerance, own vertices without a triangle of the patch are left out.

Parameters
----------
bricks : int or list of int
    Numbers as `patches` and `update` give them, each once.
edges : bool
    Whether edges are wanted, and of each triangle's corners the edge to the next one: Blender's ``.edge_verts`` and
    ``.corner_edge``.
normals : float, rad, or None
    Asks for normals of the triangles' corners on the whole mesh: the mean of the triangles around the vertex, in
    whatever brick, whose normals are within this angle of the corner's own. With a tolerance, the mean of those of the
    full mesh that bend no more than the surface under the triangle does.

Returns
-------
Patch
    Without triangles if the brick has none.

Raises
------
IndexError
    There is no such brick.
ValueError
    A brick is given twice.

Examples
--------
>>> mesher = riffler.Mesher(riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5))
>>> patch = mesher.patch(0, normals=0.5)
>>> patch.vertices.shape, patch.triangles.shape, patch.normals.shape
((210, 3), (416, 3), (1248, 3))
)")
      .def("pick", &pick_live, py::arg("origin"), py::arg("direction"), kPickText)
      .def("freeze", &freeze, R"(Copies the current surface, for picking while the mesher follows the volume.

A stroke that follows the surface on which it began does not climb into its own groove. What did not change since the
last call is shared; the first call looks at all triangles.

Returns
-------
FrozenSurface
    It never changes.

Examples
--------
>>> mesher = riffler.Mesher(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
>>> mesher.freeze().pick((10, 10, 20), (0, 0, 1)) is None
True
)")
      .def("mesh", &whole, R"(The whole mesh, the same as ``to_mesh()`` of the volume, with the mesher's tolerance.

Returns
-------
Mesh
    A new mesh.

Examples
--------
>>> riffler.Mesher(riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)).mesh().audit().open_edges
0
)")
      .def_property_readonly(
          "triangles", [](SharedMesher& self) { return (lock(self), self.mesher.triangles()); }, "Number of triangles.")
      .def_property_readonly(
          "all_triangles", [](SharedMesher& self) { return (lock(self), self.mesher.all_triangles()); },
          "Number of triangles of the full mesh; without a tolerance the same as `triangles`.")
      .def_readonly("tolerance", &SharedMesher::tolerance,
                    "The tolerance that it was made with, mm; None: all triangles.");
  bind_counters(mesher);
}

}  // namespace riffler::bindings
