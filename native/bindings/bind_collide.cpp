// Contact: Collider and what a query gives.
#include <memory>

#include "bindings/bindings.hpp"
#include "bindings/shared_volume.hpp"
#include "collide/collider.hpp"

namespace riffler {

namespace {

using NoGil = py::gil_scoped_release;

const char* name_of(Touch touch) {
  constexpr const char* kNames[] = {"cutter", "shank", "holder", "fixture"};
  return kNames[static_cast<int>(touch)];
}

std::unique_ptr<Collider> make(const Mesh& part, const std::vector<SharedVolume*>& fixtures,
                               const std::optional<double>& spacing) {
  std::vector<Volume> volumes;
  for (SharedVolume* v : fixtures) volumes.push_back(Reading(*v).volume.snapshot());
  const NoGil release;
  Collider::Settings settings;
  if (spacing) settings.spacing = *spacing;
  return std::make_unique<Collider>(part, std::move(volumes), settings);
}

std::vector<double> clearances(const Collider& self, const Tool& tool, const Doubles& array) {
  const std::vector<Pose> poses = to_poses(array, "poses");
  const NoGil release;
  const Assembly assembly(tool);
  std::vector<double> out;
  for (const Pose& pose : poses) out.push_back(self.clearance(assembly, pose));
  return out;
}

}  // namespace

void bind_collide(py::module_& m) {
  py::class_<Contact>(m, "Contact")
      .def_property_readonly("force", [](const Contact& c) { return from_vec3(c.force); })
      .def_property_readonly("torque", [](const Contact& c) { return from_vec3(c.torque); })
      .def_readonly("depth", &Contact::depth)
      .def_readonly("checked", &Contact::checked)
      .def_readonly("missed_depth_bound", &Contact::missed_depth_bound)
      .def_property_readonly("points", [](const Contact& c) { return from_vec3s(c.points); })
      .def_property_readonly("parts", [](const Contact& c) {
        py::list names;
        for (const Touch t : c.touches) names.append(name_of(t));
        return names;
      });
  py::class_<Collider>(m, "Collider")
      .def(py::init(&make), py::arg("part"), py::kw_only(), py::arg("fixtures") = py::list(),
           py::arg("spacing") = py::none())
      .def(
          "clearance",
          [](const Collider& self, const Tool& tool, const Doubles& poses) {
            return take<double>(clearances(self, tool, poses));
          },
          py::arg("tool"), py::arg("poses"));
}

}  // namespace riffler
