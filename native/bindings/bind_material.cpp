// riffler.Material
#include "bindings/bindings.hpp"
#include "riffler/haptics/material.hpp"

namespace riffler::bindings {

using namespace py::literals;

void bind_material(py::module_& m) {
  const haptics::Material usual;
  py::class_<haptics::Material>(m, "Material", R"(Properties of a stock's or fixture's material that a hand can feel.

Parameters
----------
stiffness : float
    N per mm of depth and mm² of surface; for a fixture N per mm³ in the tool.
removal_constant : float
    N·s/mm³: force for volume removed per second.
damping : float
    N·s/mm on a cutter in the cut.
density : float
    g/cm³.

Examples
--------
>>> wood = riffler.Material(removal_constant=0.03, density=0.7)
>>> wood.mass(1000)
0.7
)")
      .def(py::init([](double stiffness, double removal_constant, double damping, double density) {
             const haptics::Material material{stiffness, removal_constant, damping, density};
             material.validate("the material");
             return material;
           }),
           py::kw_only(), "stiffness"_a = usual.stiffness, "removal_constant"_a = usual.removal_constant,
           "damping"_a = usual.damping, "density"_a = usual.density)
      .def_readonly("stiffness", &haptics::Material::stiffness,
                    "N per mm of depth and mm² of surface; for a fixture N per mm³ in the tool.")
      .def_readonly("removal_constant", &haptics::Material::removal_constant,
                    "N·s/mm³: force for volume removed per second.")
      .def_readonly("damping", &haptics::Material::damping, "N·s/mm on a cutter in the cut.")
      .def_readonly("density", &haptics::Material::density, "g/cm³.")
      .def("mass", &haptics::Material::mass, "volume"_a, R"(Mass of a volume.

Parameters
----------
volume : float
    mm³.

Returns
-------
float
    g.

Examples
--------
>>> riffler.Material(density=0.7).mass(1000)
0.7
)");
}

}  // namespace riffler::bindings
