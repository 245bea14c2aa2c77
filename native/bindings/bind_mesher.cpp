#include <mutex>

#include "bindings/bindings.hpp"
#include "bindings/shared_volume.hpp"
#include "marching/mesher.hpp"

namespace riffler {

namespace {

using NoGil = py::gil_scoped_release;

/// One call at a time: calls release the GIL, and an update changes everything.
struct SharedMesher {
  explicit SharedMesher(Mesher m) : mesher(std::move(m)) {}
  Mesher mesher;
  std::mutex mutex;
};

std::unique_lock<std::mutex> lock(SharedMesher& m) {
  std::unique_lock held(m.mutex, std::try_to_lock);
  if (!held) throw std::runtime_error("the mesher is in use by another thread");
  return held;
}

Volume state_of(SharedVolume& volume) {
  return Reading(volume).volume.snapshot();
}

std::unique_ptr<SharedMesher> make(SharedVolume& volume, const py::object& callable) {
  const Progress progress = to_progress(callable);
  const Volume state = state_of(volume);
  const NoGil release;
  return std::make_unique<SharedMesher>(Mesher(state, progress));
}

py::list to_list(const std::vector<std::size_t>& numbers) {
  py::list out;
  for (const std::size_t n : numbers) out.append(n);
  return out;
}

py::tuple patch(SharedMesher& self, std::size_t brick) {
  MeshPatch patch;
  {
    const NoGil release;
    const auto held = lock(self);
    patch = self.mesher.patch(brick);
  }
  auto vertices = take<float>(std::move(patch.vertices), 3);
  return py::make_tuple(std::move(vertices), take<std::int32_t>(std::move(patch.triangles), 3));
}

}  // namespace

void bind_mesher(py::module_& m) {
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
      .def("patch", &patch, py::arg("brick"),
           R"((vertices (n, 3) float32, triangles (k, 3) int32) of one brick, empty where nothing is left.

The brick's own vertices come first, then those of its neighbours that its triangles touch; what two patches share has
the same coordinates in both, bit for bit.)")
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

}  // namespace riffler
