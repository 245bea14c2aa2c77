// riffler.Tool, and riffler.ToolShape and ToolSize: the table of cutters.
#include <array>
#include <cctype>
#include <utility>
#include <variant>

#include "bindings/bindings.hpp"
#include "riffler/tool/cutters.hpp"
#include "riffler/tool/outline.hpp"

namespace riffler::bindings {

namespace {

double number(const py::handle& value, const std::string& name) {
  try {
    return py::cast<double>(value);
  } catch (const py::cast_error&) {
    throw py::value_error(name + " must be a number");
  }
}

/// A sequence of sequences of numbers whose rows have one of two lengths.
std::vector<std::vector<double>> rows(const py::object& object, const char* name, std::size_t short_row,
                                      std::size_t long_row) {
  std::vector<std::vector<double>> out;
  try {
    out = py::cast<std::vector<std::vector<double>>>(object);
  } catch (const py::cast_error&) {
    throw py::value_error(std::string(name) + " must be a list of rows of numbers");
  }
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i].size() != short_row && out[i].size() != long_row)
      throw py::value_error(std::string(name) + ", row " + std::to_string(i) + ": " + std::to_string(short_row) +
                            (long_row != short_row ? " or " + std::to_string(long_row) : "") + " numbers expected");
  return out;
}

std::vector<tool::Frustum> to_frusta(const py::object& object, const char* name) {
  std::vector<tool::Frustum> out;
  for (const auto& r : rows(object, name, 4, 4)) out.push_back({r[0], r[1], r[2], r[3]});
  return out;
}

std::vector<tool::ProfileSegment> to_segments(const py::object& object) {
  std::vector<tool::ProfileSegment> out;
  for (const auto& r : rows(object, "segments", 2, 4))
    out.push_back({{r[0], r[1]}, r.size() == 4 ? std::optional<Vec2>(Vec2(r[2], r[3])) : std::nullopt});
  return out;
}

py::list from_frusta(const std::vector<tool::Frustum>& pieces) {
  py::list out;
  for (const tool::Frustum& f : pieces) out.append(py::make_tuple(f.z0, f.r0, f.z1, f.r1));
  return out;
}

py::list from_segments(const tool::Profile& profile) {
  py::list out;
  for (const tool::ProfileSegment& s : profile.segments())
    out.append(s.centre ? py::make_tuple(s.to.x, s.to.y, s.centre->x, s.centre->y) : py::make_tuple(s.to.x, s.to.y));
  return out;
}

py::dict to_dict(const Tool& tool) {
  py::dict d;
  d["name"] = tool.name();
  d["kind"] = tool.kind();
  for (const auto& [key, value] : tool.parameters())
    d[py::str(key)] = is_flag(tool, key) ? py::object(py::bool_(value != 0)) : py::object(py::float_(value));
  if (tool.kind() == "profile") d["segments"] = from_segments(tool.profile());
  if (!tool.shank().empty()) d["shank"] = from_frusta(tool.shank());
  if (!tool.holder().empty()) d["holder"] = from_frusta(tool.holder());
  return d;
}

/// "ball, flat, … or profile"
std::string kinds() {
  std::string out;
  for (const tool::CutterShape& shape : tool::cutter_shapes())
    out += (out.empty() ? "" : ", ") + std::string(shape.name);
  return out + " or profile";
}

Tool from_dict(const py::dict& d) {
  const auto object = [&](const char* key) {
    if (!d.contains(key)) throw py::value_error(std::string("tool: ") + key + " is missing");
    return py::object(d[key]);
  };
  const auto get = [&](const char* key) { return number(object(key), std::string("tool: ") + key); };
  const auto cutter = [&](const std::string& kind) -> Tool {
    if (kind == "profile") return cutters::profile(to_segments(object("segments")), get("length"));
    const tool::CutterShape* shape = tool::find_cutter_shape(kind);
    if (!shape) throw py::value_error("tool: kind must be " + kinds() + ", not \"" + kind + "\"");
    std::vector<double> sizes;
    for (const tool::CutterSize& size : shape->sizes)
      sizes.push_back(size.unit != tool::SizeUnit::Flag ? get(size.name)
                      : d.contains(size.name)           ? py::cast<bool>(d[size.name])
                                                        : 0.0);
    return make_cutter(*shape, sizes);
  };
  const py::object kind = object("kind");
  if (!py::isinstance<py::str>(kind)) throw py::value_error("tool: kind must be a string");
  Tool tool = cutter(py::cast<std::string>(kind));
  if (d.contains("shank")) tool = tool.with_shank(to_frusta(d["shank"], "shank"));
  if (d.contains("holder")) tool = tool.with_holder(to_frusta(d["holder"], "holder"));
  if (d.contains("name")) tool = tool.named(py::cast<std::string>(py::str(d["name"])));
  return tool;
}

/// Edges of one part that follow each other make one polyline.
py::list outline(const Tool& tool, double tolerance) {
  if (!(tolerance > 0) || !std::isfinite(tolerance)) throw py::value_error("tolerance must be positive and finite");
  constexpr const char* kNames[] = {"cutter", "shank", "holder"};
  py::list out;
  std::vector<Vec2> line;
  tool::Part part{};
  const auto flush = [&] {
    if (!line.empty()) out.append(py::make_tuple(kNames[static_cast<int>(part)], take<double>(std::move(line), 2)));
    line.clear();
  };
  const tool::Outline whole(tool);
  for (const tool::OutlineEdge& edge : whole.edges()) {
    if (!line.empty() && (edge.part != part || edge.from != line.back())) flush();
    const std::vector<Vec2> points = polyline(edge, tolerance);
    line.insert(line.end(), points.begin() + (line.empty() ? 0 : 1), points.end());
    part = edge.part;
  }
  flush();
  return out;
}

const char* unit_of(const tool::CutterSize& size) {
  constexpr const char* kUnits[] = {"mm", "rad", "bool"};
  return kUnits[static_cast<int>(size.unit)];
}

std::variant<bool, double> initial(const tool::CutterSize& size) {
  if (size.unit == tool::SizeUnit::Flag) return size.initial != 0;
  return size.initial;
}

std::string docstring(const tool::CutterShape& shape) {
  std::string out = std::string(shape.description) + ".\n";
  for (const tool::CutterSize& size : shape.sizes) {
    std::string text = size.description;
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
    out += std::string("\n- ``") + size.name + "``: " + text + (size.unit == tool::SizeUnit::Angle ? ", in rad" : "");
  }
  return out;
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

void bind_shapes(py::module_& m) {
  py::class_<tool::CutterSize>(m, "ToolSize",
                               "One size of a cutter shape. It means the same in every shape that has it.")
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
  py::class_<tool::CutterShape>(m, "ToolShape", "A named cutter shape, one row of Tool.shapes().")
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

void bind_tool(py::module_& m) {
  bind_shapes(m);
  py::class_<Tool> tool(m, "Tool", R"(A cutter with the shank and holder above it; immutable.

Heights are measured from the tip towards the spindle, lengths in mm, angles in rad. ``length`` includes the
rounded or conical end. Sizes that are not positive or do not fit raise ValueError naming the size.)");
  for (const tool::CutterShape& shape : tool::cutter_shapes()) bind_any_shape(tool, shape);
  tool.def_static(
          "shapes",
          [] { return std::vector<tool::CutterShape>(tool::cutter_shapes().begin(), tool::cutter_shapes().end()); },
          R"(The named cutter shapes with their sizes, for forms: those that have a function here but ``profile``.)")
      .def_static(
          "profile",
          [](const py::object& segments, double length) { return cutters::profile(to_segments(segments), length); },
          py::arg("segments"), py::arg("length"),
          R"(Free profile from the tip (0, 0) upwards: rows (radius, height) are lines, rows (radius, height,
centre_radius, centre_height) arcs, the shorter way round; a cylinder follows up to ``length``.)")
      .def_static("from_dict", &from_dict, py::arg("d"), "The tool of a tool library's entry; see to_dict.")
      .def("to_dict", &to_dict, "The JSON / TOML form: kind, its sizes, name, shank and holder.")
      .def(
          "with_shank",
          [](const Tool& t, const py::object& pieces) { return t.with_shank(to_frusta(pieces, "shank")); },
          py::arg("pieces"), "The same tool with a shank of truncated cones (z0, r0, z1, r1).")
      .def(
          "with_holder",
          [](const Tool& t, const py::object& pieces) { return t.with_holder(to_frusta(pieces, "holder")); },
          py::arg("pieces"), "The same tool with a holder of truncated cones (z0, r0, z1, r1).")
      .def(
          "with_margins", &Tool::with_margins, py::arg("shank") = 0.0, py::arg("holder") = 0.0,
          R"(The same tool with wider shank and holder, mm: to be planned and checked with, so that these keep clear of the
part by as much while the cutter touches it. The ends of the holder move as well, those of the shank do not.)")
      .def("named", &Tool::named, py::arg("name"), "The same tool under another name.")
      .def_property_readonly("name", &Tool::name)
      .def_property_readonly("kind", &Tool::kind)
      .def_property_readonly("diameter", &Tool::diameter, "Largest diameter of the cutter, mm.")
      .def_property_readonly("length", &Tool::length, "From the tip to the end of the cutter, mm.")
      .def_property_readonly("shank", [](const Tool& t) { return from_frusta(t.shank()); })
      .def_property_readonly("holder", [](const Tool& t) { return from_frusta(t.holder()); })
      .def("outline", &outline, py::arg("tolerance") = 0.01,
           R"(The outline of cutter, shank and holder together, from the tip upwards, for drawing.

A list of (part, points): ``"cutter"``, ``"shank"`` or ``"holder"``, and a polyline (n, 2) of radius and height, mm, that
stays within ``tolerance`` of it. What lies inside of another piece is left out.)")
      .def("__eq__", [](const Tool& a, const Tool& b) { return to_dict(a).equal(to_dict(b)); })
      .def("__hash__", [](const Tool& t) { return py::hash(py::str(to_dict(t))); })
      .def("__repr__",
           [](const Tool& t) {
             return "<riffler.Tool " + t.name() + ": " + t.kind() + ", diameter " +
                    py::cast<std::string>(py::str(py::float_(t.diameter()))) + ", length " +
                    py::cast<std::string>(py::str(py::float_(t.length()))) + ">";
           })
      .def(py::pickle([](const Tool& t) { return to_dict(t); }, [](const py::dict& d) { return from_dict(d); }));
}

}  // namespace riffler::bindings
