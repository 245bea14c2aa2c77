#include <optional>
#include <variant>

#include "bindings/bindings.hpp"
#include "bindings/one_caller.hpp"
#include "bindings/shared_volume.hpp"
#include "geom/math.hpp"
#include "marching/patch_edges.hpp"
#include "riffler/marching/mesher.hpp"

namespace riffler::bindings {

namespace {

struct SharedMesher : Guarded {
  explicit SharedMesher(marching::Mesher m) : mesher(std::move(m)) {}
  marching::Mesher mesher;
  marching::PickStats stats;  // under the GIL
};

struct SharedSurface {
  marching::FrozenSurface surface;
  marching::PickStats stats;  // under the GIL
};

/// Held through every call.
OneCaller lock(SharedMesher& m) {
  return {m, "the mesher"};
}

Volume state_of(SharedVolume& volume) {
  return Reading(volume).volume.snapshot();
}

std::unique_ptr<SharedMesher> make(SharedVolume& volume, const py::object& callable) {
  const Progress progress = to_progress(callable);
  const Volume state = state_of(volume);
  const NoGil release;
  return std::make_unique<SharedMesher>(marching::Mesher(state, progress));
}

py::list to_list(const std::vector<std::size_t>& numbers) {
  py::list out;
  for (const std::size_t n : numbers) out.append(n);
  return out;
}

using BrickOrBricks = std::variant<std::size_t, std::vector<std::size_t>>;

py::tuple patch(SharedMesher& self, const BrickOrBricks& bricks, bool with_edges, const std::optional<double>& sharp) {
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
  py::list out;
  out.append(take<float>(std::move(patch.vertices), 3));
  out.append(take<std::int32_t>(std::move(patch.triangles), 3));
  if (with_edges) {
    out.append(take<std::int32_t>(std::move(edges.vertices), 2));
    out.append(take<std::int32_t>(std::move(edges.of_corner), 3));
  }
  if (sharp) out.append(take<float>(std::move(normals), 3));
  return py::tuple(out);
}

using Hits = std::vector<std::optional<marching::SurfaceHit>>;

py::object from_hit(const std::optional<marching::SurfaceHit>& hit) {
  if (!hit) return py::none();
  return py::make_tuple(hit->distance, from_vec3(hit->point), from_vec3(hit->normal), hit->brick);
}

py::tuple from_hits(const Hits& hits) {
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
  return py::make_tuple(take<double>(std::move(distances)), from_vec3s(points), from_vec3s(normals),
                        take<std::int64_t>(std::move(bricks)));
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
  return one ? from_hit(hits[0]) : py::object(from_hits(hits));
}

template <class Pickable>
Hits hits_of(Pickable& surface, const std::vector<Vec3>& origins, const std::vector<Vec3>& directions,
             marching::PickStats& stats) {
  Hits hits;
  for (std::size_t n = 0; n < origins.size(); ++n) hits.push_back(surface.pick(origins[n], directions[n], stats));
  return hits;
}

py::object pick_live(SharedMesher& self, const Doubles& origin, const Doubles& direction) {
  return pick(origin, direction, self.stats,
              [&](const auto& origins, const auto& directions, marching::PickStats& stats) {
                const auto held = lock(self);
                return hits_of(self.mesher, origins, directions, stats);
              });
}

py::object pick_frozen(SharedSurface& self, const Doubles& origin, const Doubles& direction) {
  return pick(origin, direction, self.stats,
              [&](const auto& origins, const auto& directions, marching::PickStats& stats) {
                return hits_of(self.surface, origins, directions, stats);
              });
}

py::dict stats(marching::PickStats& sum) {
  using namespace py::literals;
  const marching::PickStats s = std::exchange(sum, {});
  return py::dict("rays"_a = s.rays, "bricks_visited"_a = s.bricks_visited, "bricks_prepared"_a = s.bricks_prepared,
                  "triangles_tested"_a = s.triangles_tested);
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
    R"(The first point of the surface along a ray: ``(distance, point, normal, brick)``, or None.

``direction`` may have any length but 0; ``distance`` is in mm. ``normal`` is that of the triangle that was hit, a unit
vector out of the material: it points along the ray where the ray comes from inside. No ray falls through between
triangles, and one that touches an edge hits it. With (n, 3) arrays, one ray a row, arrays of n rows: where nothing is
hit ``distance`` is inf, ``brick`` -1, the rest NaN. ValueError naming the argument and row for what is not finite, or
zero.)";

void bind_frozen_surface(py::module_& m) {
  py::class_<SharedSurface>(
      m, "FrozenSurface",
      R"(The surface of a ``Mesher`` as it was when ``freeze()`` was called, to be picked, whatever becomes of the mesher.)")
      .def("pick", &pick_frozen, py::arg("origin"), py::arg("direction"), kPickText)
      .def(
          "stats", [](SharedSurface& self) { return stats(self.stats); },
          "What picking took since the last call of stats(): rays, bricks_visited, triangles_tested.")
      .def_property_readonly("triangles", [](const SharedSurface& self) { return self.surface.triangles(); })
      .def_property_readonly(
          "nbytes", [](const SharedSurface& self) { return self.surface.nbytes(); },
          "Bytes of its triangles, of which it shares those of bricks that did not change with the mesher.");
}

}  // namespace

void bind_mesher(py::module_& m) {
  bind_frozen_surface(m);
  py::class_<SharedMesher>(m, "Mesher", R"(The mesh of a volume that goes on changing, in bricks of 32 × 32 × 32 cells.

``Mesher(volume)`` meshes all of it; ``update(volume)`` meshes again only where it was changed. What a mesher holds is
always, bit for bit, what ``volume.to_mesh()`` gives. It keeps a snapshot of the volume, which shares its tiles.)")
      .def(py::init(&make), py::arg("volume"), py::arg("progress") = py::none(),
           "``progress``: called with the finished share; returning False cancels and raises Cancelled.")
      .def(
          "update",
          [](SharedMesher& self, SharedVolume& volume) {
            const Volume state = state_of(volume);
            std::vector<std::size_t> changed;
            {
              const NoGil release;
              const auto held = lock(self);
              changed = self.mesher.update(state);
            }
            return to_list(changed);
          },
          py::arg("volume"),
          "Follows a change of the volume and returns the numbers of the bricks whose patches changed, ascending. "
          "ValueError for a volume with another box, pitch or directions.")
      .def(
          "patches", [](SharedMesher& self) { return to_list((lock(self), self.mesher.patches())); },
          "Numbers of the bricks that have triangles, ascending.")
      .def_property_readonly(
          "shape",
          [](SharedMesher& self) {
            const Vec3i shape = (lock(self), self.mesher.shape());
            return py::make_tuple(shape.x, shape.y, shape.z);
          },
          "Bricks along each axis, with triangles or without: brick n stands at ``numpy.unravel_index(n, shape)``.")
      .def("patch", &patch, py::arg("bricks"), py::arg("edges") = false, py::arg("normals") = py::none(),
           R"((vertices (n, 3) float32, triangles (k, 3) int32) of a brick, empty where nothing is left.

The brick's own vertices come first, then those of its neighbours that its triangles touch; what two patches share has
the same coordinates in both, bit for bit. A sequence of bricks gives one patch of them all, without seams between them.

``edges=True`` adds edges (e, 2) int32, each once, and of each triangle's corners the edge to the next one, (k, 3)
int32: Blender's ``.edge_verts`` and ``.corner_edge``. IndexError for a brick that there is not, ValueError for one
that is there twice.

``normals``, an angle in rad, adds normals (3 k, 3) float32 of the triangles' corners on the whole mesh: the mean of the
triangles around the vertex, in whatever brick, whose normals are within that angle of the corner's own.)")
      .def("pick", &pick_live, py::arg("origin"), py::arg("direction"), kPickText)
      .def("freeze", &freeze,
           R"(The surface as it is now, to be picked while the mesher goes on: a ``FrozenSurface``.

A stroke that follows the surface on which it began does not climb into its own groove. What did not change since the
last call is shared; the first call looks at all triangles.)")
      .def(
          "stats", [](SharedMesher& self) { return stats(self.stats); },
          "What picking and freezing took since the last call of stats(): rays, bricks_visited, bricks_prepared (those "
          "that had changed), triangles_tested.")
      .def(
          "mesh",
          [](SharedMesher& self) {
            const NoGil release;
            const auto held = lock(self);
            return self.mesher.mesh();
          },
          "The whole mesh, the same as ``to_mesh()`` of the volume.")
      .def_property_readonly("triangles", [](SharedMesher& self) { return (lock(self), self.mesher.triangles()); });
}

}  // namespace riffler::bindings
