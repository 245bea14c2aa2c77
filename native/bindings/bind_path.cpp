// Paths along a part: PencilPath.
#include <memory>

#include "bindings/bindings.hpp"
#include "plan/path.hpp"

namespace riffler {

namespace {

using Pairs = std::vector<std::array<Vec3, 2>>;

py::array_t<double> from_pairs(const Pairs& pairs) {
  py::array_t<double> out({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}, py::ssize_t{3}});
  auto to = out.mutable_unchecked<3>();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < 3; ++i) to(static_cast<py::ssize_t>(k), side, i) = pairs[k][side][i];
  return out;
}

}  // namespace

void bind_path(py::module_& m) {
  py::class_<PencilPath, std::shared_ptr<PencilPath>>(
      m, "PencilPath", "A curve of ball centres along a part, with what the ball touches at each. See riffler.plan.")
      .def_readonly("radius", &PencilPath::radius, "Of the ball, mm.")
      .def_readonly("closed", &PencilPath::closed, "A loop: its last point is joined to its first.")
      .def_property_readonly("length", &PencilPath::length, "mm, of the closing edge too.")
      .def_property_readonly(
          "centres", [](const PencilPath& p) { return from_vec3s(p.centres); }, "(n, 3) mm")
      .def_property_readonly(
          "contacts", [](const PencilPath& p) { return from_pairs(p.contacts); }, "(n, 2, 3) mm")
      .def_property_readonly(
          "normals", [](const PencilPath& p) { return from_pairs(p.normals); },
          "(n, 2, 3): unit normals of the part at the contacts, out of the material.")
      .def("__len__", &PencilPath::size);
}

}  // namespace riffler
