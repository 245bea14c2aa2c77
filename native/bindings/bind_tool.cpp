// riffler.Tool
#include <pybind11/typing.h>

#include <functional>

#include "bindings/bindings.hpp"
#include "bindings/typed.hpp"
#include "riffler/tool/cutters.hpp"
#include "riffler/tool/outline.hpp"

namespace riffler::bindings {

/// The functions of Tool that make named cutters, and their table (bind_tool_shapes.cpp).
void bind_tool_shapes(py::module_& m, py::class_<Tool>& tool);
/// The functions of Tool that make hand tools (bind_hand_tools.cpp).
void bind_hand_tools(py::class_<Tool>& tool);
/// The hand tool of a dict of its kind and sizes; nothing for other kinds.
std::optional<Tool> hand_tool_from(const std::string& kind, const std::function<double(const char*)>& size,
                                   const std::function<py::object(const char*)>& object);

namespace {

RIFFLER_TYPED(RowsLike, "numpy.typing.ArrayLike | collections.abc.Sequence[collections.abc.Sequence[float]]")
RIFFLER_TYPED(ToolFields, "dict[str, bool | float | str | list[tuple[float, ...]]]")
RIFFLER_TYPED(OutlineList, "list[tuple[str, numpy.typing.NDArray[numpy.float64]]]")

using FrustumList = py::typing::List<py::typing::Tuple<double, double, double, double>>;

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

FrustumList from_frusta(const std::vector<tool::Frustum>& pieces) {
  FrustumList out;
  for (const tool::Frustum& f : pieces) out.append(py::make_tuple(f.z0, f.r0, f.z1, f.r1));
  return out;
}

py::list from_segments(const tool::Profile& profile) {
  py::list out;
  for (const tool::ProfileSegment& s : profile.segments()) {
    if (s.centre)
      out.append(py::make_tuple(s.to.x, s.to.y, s.centre->x, s.centre->y));
    else
      out.append(py::make_tuple(s.to.x, s.to.y));
  }
  return out;
}

py::dict to_dict(const Tool& tool) {
  py::dict d;
  d["name"] = tool.name();
  d["kind"] = tool.kind();
  for (const auto& [key, value] : tool.parameters())
    d[py::str(key)] = is_flag(tool, key) ? py::object(py::bool_(value != 0)) : py::object(py::float_(value));
  if (tool.kind() == "profile") d["segments"] = from_segments(tool.profile());
  if (tool.kind() == "convex") {
    py::list hulls;
    for (const tool::Hull& hull : tool.hulls()) {
      py::list points;
      for (const Vec3& p : hull.vertices) points.append(py::make_tuple(p.x, p.y, p.z));
      hulls.append(points);
    }
    d["hulls"] = hulls;
  }
  if (!tool.shank().empty()) d["shank"] = from_frusta(tool.shank());
  if (!tool.holder().empty()) d["holder"] = from_frusta(tool.holder());
  return d;
}

/// "ball, flat, … or profile"
std::string kinds() {
  std::string out;
  for (const tool::CutterShape& shape : tool::cutter_shapes())
    out += (out.empty() ? "" : ", ") + std::string(shape.name);
  return out + ", profile, convex, chisel, gouge, v_tool or knife";
}

Tool from_dict(const py::dict& d) {
  const auto object = [&](const char* key) {
    if (!d.contains(key)) throw py::value_error(std::string("tool: ") + key + " is missing");
    return py::object(d[key]);
  };
  const auto get = [&](const char* key) { return number(object(key), std::string("tool: ") + key); };
  const auto cutter = [&](const std::string& kind) -> Tool {
    if (kind == "profile") return cutters::profile(to_segments(object("segments")), get("length"));
    if (const auto hand = hand_tool_from(kind, get, object)) return *hand;
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
OutlineList outline(const Tool& tool, double tolerance) {
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
  return py::object(out);
}

}  // namespace

void bind_tool(py::module_& m) {
  py::class_<Tool> tool(m, "Tool", R"(A cutter with the shank and holder above it; immutable.

Heights are measured from the tip towards the spindle, lengths in mm, angles in rad. ``length`` includes the
rounded or conical end. Sizes that are not positive or do not fit raise ValueError naming the size.

Examples
--------
>>> riffler.Tool.ball(diameter=6, length=30) == riffler.Tool.ball(6, 30)
True
)");
  bind_tool_shapes(m, tool);
  bind_hand_tools(tool);
  tool.def_static(
          "shapes",
          [] { return std::vector<tool::CutterShape>(tool::cutter_shapes().begin(), tool::cutter_shapes().end()); },
          R"(The named cutter shapes with their sizes, for forms: all that have a function here except `profile`.

Returns
-------
list of ToolShape
    In the order of the table.

Examples
--------
>>> [shape.name for shape in riffler.Tool.shapes()][:2]
['ball', 'flat']
)")
      .def_static(
          "profile",
          [](const RowsLike& segments, double length) { return cutters::profile(to_segments(segments), length); },
          py::arg("segments"), py::arg("length"),
          R"(A free profile from the tip (0, 0) upwards; a cylinder follows up to ``length``.

Parameters
----------
segments : list of rows of 2 or 4 numbers, mm
    (radius, height): a line to this point; (radius, height, centre_radius, centre_height): the shorter arc to it.
length : float, mm
    Cutting length from the tip.

Returns
-------
Tool
    A tool without shank and holder.

Raises
------
ValueError
    Names the row.

Examples
--------
>>> riffler.Tool.profile([(2, 0), (3, 1)], length=20).diameter
6.0
)")
      .def_static("from_dict", &from_dict, py::arg("d"), R"(The tool of a tool library's entry.

Parameters
----------
d : dict with the keys of `to_dict`
    Kind and sizes; name, shank and holder if the tool has them.

Returns
-------
Tool
    Equal to the tool whose `to_dict` this is.

Raises
------
ValueError
    Names the key that is missing or wrong.

Examples
--------
>>> riffler.Tool.from_dict({"kind": "ball", "diameter": 6, "length": 30}).diameter
6.0
)")
      .def(
          "to_dict", [](const Tool& t) { return ToolFields(to_dict(t)); },
          R"(The JSON / TOML form: kind, its sizes, name, shank and holder.

Returns
-------
dict
    Numbers, texts and lists only.

Examples
--------
>>> riffler.Tool.ball(6, 30).to_dict()["kind"]
'ball'
)")
      .def(
          "with_shank", [](const Tool& t, const ArrayLike& pieces) { return t.with_shank(to_frusta(pieces, "shank")); },
          py::arg("pieces"), R"(The same tool with another shank.

Parameters
----------
pieces : array_like of shape (k, 4), mm
    Truncated cones (z0, r0, z1, r1), heights from the tip.

Returns
-------
Tool
    A new tool.

Raises
------
ValueError
    Names the row.

Examples
--------
>>> riffler.Tool.ball(6, 30).with_shank([(30, 3, 60, 3)]).shank
[(30.0, 3.0, 60.0, 3.0)]
)")
      .def(
          "with_holder",
          [](const Tool& t, const ArrayLike& pieces) { return t.with_holder(to_frusta(pieces, "holder")); },
          py::arg("pieces"), R"(The same tool with another holder.

Parameters
----------
pieces : array_like of shape (k, 4), mm
    Truncated cones (z0, r0, z1, r1), heights from the tip.

Returns
-------
Tool
    A new tool.

Raises
------
ValueError
    Names the row.

Examples
--------
>>> riffler.Tool.ball(6, 30).with_holder([(40, 15, 80, 20)]).holder
[(40.0, 15.0, 80.0, 20.0)]
)")
      .def("with_margins", &Tool::with_margins, py::kw_only(), py::arg("shank") = 0.0, py::arg("holder") = 0.0,
           R"(The same tool with a wider shank and holder, to plan and check with a safety margin.

The ends of the holder move too, those of the shank do not.

Parameters
----------
shank, holder : float, mm
    Added width of each on every side.

Returns
-------
Tool
    A new tool.

Raises
------
ValueError
    A negative margin.

Examples
--------
>>> riffler.Tool.ball(6, 30).with_shank([(30, 3, 60, 3)]).with_margins(shank=0.5).shank
[(30.0, 3.5, 60.0, 3.5)]
)")
      .def("named", &Tool::named, py::arg("name"), R"(The same tool under another name.

Parameters
----------
name : str
    For messages and tool libraries.

Returns
-------
Tool
    A new tool.

Examples
--------
>>> riffler.Tool.ball(6, 30).named("finisher").name
'finisher'
)")
      .def_property_readonly("name", &Tool::name, "Name in messages and tool libraries.")
      .def_property_readonly("kind", &Tool::kind,
                             "\"ball\", \"flat\" …, \"profile\", or a hand tool's: \"chisel\", …, \"convex\".")
      .def_property_readonly("diameter", &Tool::diameter, "Largest diameter of the cutter, mm.")
      .def_property_readonly("length", &Tool::length, "Length from the tip to the end of the cutter, mm.")
      .def_property_readonly(
          "shank", [](const Tool& t) { return from_frusta(t.shank()); }, "Truncated cones (z0, r0, z1, r1), mm.")
      .def_property_readonly(
          "holder", [](const Tool& t) { return from_frusta(t.holder()); }, "Truncated cones (z0, r0, z1, r1), mm.")
      .def("outline", &outline, py::kw_only(), py::arg("tolerance") = 0.01,
           R"(The outline of cutter, shank and holder together, from the tip upwards, for drawing.

Parts inside another piece are left out.

Parameters
----------
tolerance : float, mm
    Largest distance of polylines from arcs.

Returns
-------
list of (str, ndarray of shape (n, 2), mm)
    "cutter", "shank" or "holder", and a polyline of radius and height.

Raises
------
ValueError
    A tolerance that is not positive.

Examples
--------
>>> [(part, line.tolist()) for part, line in riffler.Tool.flat(6, 30).outline()][0]
('cutter', [[0.0, 0.0], [3.0, 0.0], [3.0, 30.0], [0.0, 30.0]])
)")
      .def(
          "__eq__", [](const Tool& a, const Tool& b) { return to_dict(a).equal(to_dict(b)); }, py::is_operator())
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
