// riffler.Tool
#include "bindings/bindings.hpp"
#include "tool/cutters.hpp"
#include "tool/outline.hpp"

namespace riffler {

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

std::vector<Frustum> to_frusta(const py::object& object, const char* name) {
  std::vector<Frustum> out;
  for (const auto& r : rows(object, name, 4, 4)) out.push_back({r[0], r[1], r[2], r[3]});
  return out;
}

std::vector<ProfileSegment> to_segments(const py::object& object) {
  std::vector<ProfileSegment> out;
  for (const auto& r : rows(object, "segments", 2, 4))
    out.push_back({{r[0], r[1]}, r.size() == 4 ? std::optional<Vec2>(Vec2(r[2], r[3])) : std::nullopt});
  return out;
}

py::list from_frusta(const std::vector<Frustum>& pieces) {
  py::list out;
  for (const Frustum& f : pieces) out.append(py::make_tuple(f.z0, f.r0, f.z1, f.r1));
  return out;
}

py::list from_segments(const Profile& profile) {
  py::list out;
  for (const ProfileSegment& s : profile.segments())
    out.append(s.centre ? py::make_tuple(s.to.x, s.to.y, s.centre->x, s.centre->y) : py::make_tuple(s.to.x, s.to.y));
  return out;
}

py::dict to_dict(const Tool& tool) {
  py::dict d;
  d["name"] = tool.name();
  d["kind"] = tool.kind();
  for (const auto& [key, value] : tool.parameters())
    d[py::str(key)] = key == "flat_tip" ? py::object(py::bool_(value != 0)) : py::object(py::float_(value));
  if (tool.kind() == "profile") d["segments"] = from_segments(tool.profile());
  if (!tool.shank().empty()) d["shank"] = from_frusta(tool.shank());
  if (!tool.holder().empty()) d["holder"] = from_frusta(tool.holder());
  return d;
}

Tool from_dict(const py::dict& d) {
  const auto object = [&](const char* key) {
    if (!d.contains(key)) throw py::value_error(std::string("tool: ") + key + " is missing");
    return py::object(d[key]);
  };
  const auto get = [&](const char* key) { return number(object(key), std::string("tool: ") + key); };
  const auto cutter = [&](const std::string& kind) -> Tool {
    if (kind == "ball") return cutters::ball(get("diameter"), get("length"));
    if (kind == "flat") return cutters::flat(get("diameter"), get("length"));
    if (kind == "fillet") return cutters::fillet(get("diameter"), get("corner_radius"), get("length"));
    if (kind == "taper")
      return cutters::taper(get("tip_radius"), get("half_angle"), get("diameter"), get("length"),
                            d.contains("flat_tip") && py::cast<bool>(d["flat_tip"]));
    if (kind == "cone_end")
      return cutters::cone_end(get("tip_half_angle"), get("tip_height"), get("half_angle"), get("diameter"),
                               get("length"));
    if (kind == "profile") return cutters::profile(to_segments(object("segments")), get("length"));
    throw py::value_error("tool: kind must be ball, flat, fillet, taper, cone_end or profile, not \"" + kind + "\"");
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
  Part part{};
  const auto flush = [&] {
    if (!line.empty()) out.append(py::make_tuple(kNames[static_cast<int>(part)], take<double>(std::move(line), 2)));
    line.clear();
  };
  const Outline whole(tool);
  for (const OutlineEdge& edge : whole.edges()) {
    if (!line.empty() && (edge.part != part || edge.from != line.back())) flush();
    const std::vector<Vec2> points = polyline(edge, tolerance);
    line.insert(line.end(), points.begin() + (line.empty() ? 0 : 1), points.end());
    part = edge.part;
  }
  flush();
  return out;
}

}  // namespace

void bind_tool(py::module_& m) {
  py::class_<Tool>(m, "Tool", R"(A cutter with the shank and holder above it; immutable.

Heights are measured from the tip towards the spindle, lengths in mm, angles in rad. ``length`` includes the
rounded or conical end. Sizes that are not positive or do not fit raise ValueError naming the size.)")
      .def_static("ball", &cutters::ball, py::arg("diameter"), py::arg("length"), "Ball end mill.")
      .def_static("flat", &cutters::flat, py::arg("diameter"), py::arg("length"), "Flat end mill.")
      .def_static("fillet", &cutters::fillet, py::arg("diameter"), py::arg("corner_radius"), py::arg("length"),
                  "Bull nose: a flat end mill whose edge is rounded.")
      .def_static("taper", &cutters::taper, py::arg("tip_radius"), py::arg("half_angle"), py::arg("diameter"),
                  py::arg("length"), py::arg("flat_tip") = false,
                  "Cone above a tangent ball tip (or a flat one) up to the diameter, then a cylinder.")
      .def_static("cone_end", &cutters::cone_end, py::arg("tip_half_angle"), py::arg("tip_height"),
                  py::arg("half_angle"), py::arg("diameter"), py::arg("length"),
                  "Sharp tip, a cone up to tip_height, a second cone up to the diameter, then a cylinder.")
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

}  // namespace riffler
