// riffler.ToolShape and ToolSize: the table of cutters, and the functions of riffler.Tool that are made from it.
#include <array>
#include <utility>
#include <variant>

#include "bindings/bindings.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::bindings {

void bind_tool_shapes(py::module_& m, py::class_<Tool>& tool);

namespace {

const char* unit_of(const tool::CutterSize& size) {
  constexpr const char* kUnits[] = {"mm", "rad", "bool"};
  return kUnits[static_cast<int>(size.unit)];
}

std::variant<bool, double> initial(const tool::CutterSize& size) {
  if (size.unit == tool::SizeUnit::Flag) return size.initial != 0;
  return size.initial;
}

/// A size's value in an example: its first one in a form.
std::string example_value(const tool::CutterSize& size) {
  if (size.unit == tool::SizeUnit::Flag) return size.initial != 0 ? "True" : "False";
  return py::cast<std::string>(py::repr(py::float_(size.initial)));
}

const char* kind_of(const tool::CutterSize& size) {
  constexpr const char* kKinds[] = {"float, mm", "float, rad", "bool"};
  return kKinds[static_cast<int>(size.unit)];
}

std::string docstring(const tool::CutterShape& shape) {
  std::string out = std::string(shape.description) + ".\n\nParameters\n----------\n", values;
  for (const tool::CutterSize& size : shape.sizes) {
    out += std::string(size.name) + " : " + kind_of(size) + "\n    " + size.description + ".\n";
    values += (values.empty() ? "" : ", ") + std::string(size.name) + "=" + example_value(size);
  }
  return out +
         "\nReturns\n-------\nTool\n    A tool without shank and holder.\n\nRaises\n------\nValueError\n"
         "    Names the size that is not positive or does not fit the others.\n\nExamples\n--------\n>>> "
         "riffler.Tool." +
         shape.name + "(" + values + ").kind\n'" + shape.name + "'\n";
}

template <class T, std::size_t>
using Each = T;

/// Tool.<shape>(sizes): numbers, then flags, which are false by default.
template <std::size_t... number, std::size_t... flag>
void bind_shape(py::class_<Tool>& tool, const tool::CutterShape& shape, std::index_sequence<number...>,
                std::index_sequence<flag...>) {
  tool.def_static(
      shape.name,
      [&shape](Each<double, number>... numbers, Each<bool, flag>... flags) {
        return make_cutter(shape, std::array{numbers..., static_cast<double>(flags)...});
      },
      py::arg(shape.sizes[number].name)..., (py::arg(shape.sizes[sizeof...(number) + flag].name) = false)...,
      docstring(shape).c_str());
}

/// Tool.<shape>, which has `count` numbers or more.
template <std::size_t count = 2>
void bind_any_shape(py::class_<Tool>& tool, const tool::CutterShape& shape) {
  constexpr std::size_t kMaxNumbers = 8;
  std::size_t numbers = 0;
  while (numbers < shape.sizes.size() && shape.sizes[numbers].unit != tool::SizeUnit::Flag) ++numbers;
  const std::size_t flags = shape.sizes.size() - numbers;
  if constexpr (count <= kMaxNumbers) {
    if (numbers != count) return bind_any_shape<count + 1>(tool, shape);
    if (flags == 0) return bind_shape(tool, shape, std::make_index_sequence<count>(), std::index_sequence<>());
    if (flags == 1) return bind_shape(tool, shape, std::make_index_sequence<count>(), std::index_sequence<0>());
  }
  throw std::logic_error(std::string(shape.name) + ": a shape has 2 to 8 numbers, then one flag at most");
}

void bind_table(py::module_& m) {
  py::class_<tool::CutterSize>(
      m, "ToolSize", "One size of a cutter shape. It means the same in every shape that has it. See `Tool.shapes`.")
      .def_readonly("name", &tool::CutterSize::name, "The argument's name, and the key in a tool's dict.")
      .def_property_readonly("unit", &unit_of, "\"mm\", \"rad\" or \"bool\".")
      .def_readonly("label", &tool::CutterSize::label, "Short name for a form.")
      .def_readonly("description", &tool::CutterSize::description, "One phrase for a form's tooltip.")
      .def_readonly("low", &tool::CutterSize::low, "Smallest value that a form should offer.")
      .def_readonly("high", &tool::CutterSize::high, "Largest value that a form should offer.")
      .def_property_readonly("default", &initial, "First value of a form; suits a cutter of 6 mm.")
      .def_property_readonly(
          "largest", [](const tool::CutterSize& s) { return s.largest > 0 ? std::optional(s.largest) : std::nullopt; },
          "Largest multiple of the diameter that a form should offer, or None.")
      .def("__repr__", [](const tool::CutterSize& s) { return "<riffler.ToolSize " + std::string(s.name) + ">"; });
  py::class_<tool::CutterShape>(m, "ToolShape",
                                "A named cutter shape, one row of the table of cutters. See `Tool.shapes`.")
      .def_readonly("name", &tool::CutterShape::name,
                    "The kind of its tools, and the function of Tool that makes them.")
      .def_readonly("label", &tool::CutterShape::label, "Short name for a form.")
      .def_readonly("description", &tool::CutterShape::description, "One phrase for a form's tooltip.")
      .def_property_readonly(
          "sizes",
          [](const tool::CutterShape& s) { return std::vector<tool::CutterSize>(s.sizes.begin(), s.sizes.end()); },
          "In the order of the function's arguments; one is \"diameter\", one \"length\".")
      .def("__repr__", [](const tool::CutterShape& s) { return "<riffler.ToolShape " + std::string(s.name) + ">"; });
}

}  // namespace

void bind_tool_shapes(py::module_& m, py::class_<Tool>& tool) {
  bind_table(m);
  for (const tool::CutterShape& shape : tool::cutter_shapes()) bind_any_shape(tool, shape);
}

}  // namespace riffler::bindings
