#include "bindings/program_arguments.hpp"

#include <cmath>

#include "nc/limits.hpp"

namespace riffler::bindings {

ProgramClass program_class(const py::module_& m) {
  return py::reinterpret_borrow<ProgramClass>(m.attr("Program"));
}

Doubles to_doubles(const py::handle& object, const std::string& name) {
  auto array = Doubles::ensure(object);
  if (!array) {
    PyErr_Clear();
    throw py::value_error(name + " must be numbers");
  }
  return array;
}

std::vector<double> to_column(const py::handle& object, std::size_t rows, const std::string& name, bool spread) {
  const Doubles array = to_doubles(object, name);
  if (array.ndim() == 0) return std::vector<double>(spread ? rows : 1, *array.data());
  if (array.ndim() != 1 || static_cast<std::size_t>(array.shape(0)) != rows)
    throw py::value_error(name + " must be one number or have the shape (" + std::to_string(rows) + ",)");
  return {array.data(), array.data() + rows};
}

std::vector<std::vector<Vec3>> to_curves(const ArraysLike& arrays, const std::string& name) {
  std::vector<std::vector<Vec3>> curves;
  for (const py::handle curve : arrays)
    curves.push_back(to_vec3s(py::cast<Doubles>(curve), (name + "[" + std::to_string(curves.size()) + "]").c_str()));
  return curves;
}

int to_number(double value, const std::string& name, std::size_t row) {
  if (!(value >= 0 && value <= nc::kMaxNumber && value == std::floor(value)))
    throw py::value_error(name + ", row " + std::to_string(row) + ": must be a whole number from 0 to " +
                          std::to_string(nc::kMaxNumber));
  return static_cast<int>(value);
}

std::map<int, Tool> to_tools(const ToolsLike& object, int lowest) {
  std::map<int, Tool> out;
  if (object.is_none()) return out;
  constexpr const char* kExpected = "tools must be a dict: number to Tool";
  if (!py::isinstance<py::dict>(object)) throw py::value_error(kExpected);
  for (const auto& [key, value] : py::cast<py::dict>(object)) {
    if (!py::isinstance<py::int_>(key) || !py::isinstance<Tool>(value)) throw py::value_error(kExpected);
    const double number = py::cast<double>(key);
    if (number < lowest) throw py::value_error("tools: numbers begin at " + std::to_string(lowest));
    const auto& tool = py::cast<const Tool&>(value);
    tool.require_revolved("tools: a program");
    out.emplace(to_number(number, "tools", out.size()), tool);
  }
  return out;
}

nc::Provenance to_provenance(const StringsLike& object) {
  nc::Provenance out;
  if (object.is_none()) return out;
  if (!py::isinstance<py::dict>(object)) throw py::value_error("provenance must be a dict of strings");
  for (const auto& [key, value] : py::cast<py::dict>(object))
    out.emplace_back(py::cast<std::string>(py::str(key)), py::cast<std::string>(py::str(value)));
  return out;
}

}  // namespace riffler::bindings
