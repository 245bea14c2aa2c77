// The functions of riffler.Tool that make hand tools, and their bodies.
#include <pybind11/typing.h>

#include <algorithm>
#include <functional>

#include "bindings/bindings.hpp"
#include "bindings/typed.hpp"
#include "riffler/tool/hand_tools.hpp"

namespace riffler::bindings {

void bind_hand_tools(py::class_<Tool>& tool);
std::optional<Tool> hand_tool_from(const std::string& kind, const std::function<double(const char*)>& size,
                                   const std::function<py::object(const char*)>& object);

namespace {

RIFFLER_TYPED(HullsLike, "collections.abc.Sequence[numpy.typing.ArrayLike]")
using HullList = py::typing::List<py::array_t<double>>;

Tool from_hulls_like(const py::object& hulls) {
  std::vector<std::vector<Vec3>> bodies;
  if (!py::isinstance<py::sequence>(hulls) || py::isinstance<py::str>(hulls))
    throw py::value_error("hulls must be a list of arrays of the shape (k, 3)");
  for (const py::handle item : py::cast<py::sequence>(hulls)) {
    const std::string name = "hulls[" + std::to_string(bodies.size()) + "]";
    Doubles points;
    try {
      points = py::cast<Doubles>(py::reinterpret_borrow<py::object>(item));
    } catch (const py::cast_error&) {
      throw py::value_error(name + " must have the shape (k, 3)");
    }
    bodies.push_back(to_vec3s(points, name.c_str()));
  }
  return hand_tools::convex(bodies);
}

HullList from_hulls(const Tool& tool) {
  HullList out;
  for (const tool::Hull& hull : tool.hulls()) out.append(from_vec3s(hull.vertices));
  return out;
}

}  // namespace

bool is_hand_tool(const std::string& kind) {
  const auto kinds = {"convex", "chisel", "gouge", "v_tool", "knife"};
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

std::optional<Tool> hand_tool_from(const std::string& kind, const std::function<double(const char*)>& size,
                                   const std::function<py::object(const char*)>& object) {
  if (kind == "convex") return from_hulls_like(object("hulls"));
  if (kind == "chisel")
    return hand_tools::chisel(size("width"), size("thickness"), size("bevel"), size("length"), size("skew"));
  if (kind == "gouge") return hand_tools::gouge(size("width"), size("radius"), size("bevel"), size("length"));
  if (kind == "v_tool") return hand_tools::v_tool(size("angle"), size("width"), size("bevel"), size("length"));
  if (kind == "knife") return hand_tools::knife(size("width"), size("thickness"), size("edge_angle"), size("length"));
  return std::nullopt;
}

void bind_hand_tools(py::class_<Tool>& tool) {
  tool.def_static(
          "convex", [](const HullsLike& hulls) { return from_hulls_like(hulls); }, py::arg("hulls"),
          R"(A hand tool: the union of the convex hulls of points. No body of revolution, so its poses have a roll.

Parameters
----------
hulls : list of array_like of shape (k, 3), mm
    Points of each body, in the tool's frame: z from the tip to the handle, x the cutting direction, y across.

Returns
-------
Tool
    For `Volume.carve` with poses of shape (n, 9); what needs a body of revolution refuses it.

Raises
------
ValueError
    Names the body: fewer than four points or more than 128, one that is not finite, or a flat body.

Examples
--------
>>> wedge = riffler.Tool.convex([[(0, -3, 0), (0, 3, 0), (2, -3, 4), (2, 3, 4), (0, -3, 20), (0, 3, 20)]])
>>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
>>> cut = volume.carve(wedge, [[5, 10, 8, 0, 0, 1, 1, 0, 0], [15, 10, 8, 0, 0, 1, 1, 0, 0]])
>>> cut.removed.round(3).tolist()
[126.0]
)")
      .def_static("chisel", &hand_tools::chisel, py::arg("width"), py::arg("thickness"), py::arg("bevel"),
                  py::arg("length"), py::arg("skew") = 0.0,
                  R"(A hand tool: a flat blade with its edge across the tip, flat behind, ground in front.

Parameters
----------
width, thickness : float, mm
    Of the blade, across and along the cutting direction.
bevel : float, rad
    Between the flat back and the ground face.
length : float, mm
    From the tip to the upper end.
skew : float, rad
    Turns the edge about the cutting direction; the tip stays its middle.

Returns
-------
Tool
    For poses of shape (n, 9); see `convex`.

Raises
------
ValueError
    Names the size that is not positive or does not fit the others.

Examples
--------
>>> riffler.Tool.chisel(width=12, thickness=3, bevel=0.5, length=60).name
'chisel 12'
)")
      .def_static("gouge", &hand_tools::gouge, py::arg("width"), py::arg("radius"), py::arg("bevel"), py::arg("length"),
                  R"(A hand tool: a blade with a round channel, filled up to the rims, so that the chip is taken out.

Parameters
----------
width : float, mm
    Between the rims; at most twice the radius.
radius : float, mm
    Of the sweep. The arc is a polygon in it, within 0.01 mm or of 24 sides.
bevel : float, rad
    Between the outer side and the ground end.
length : float, mm
    From the tip to the upper end.

Returns
-------
Tool
    For poses of shape (n, 9); see `convex`.

Raises
------
ValueError
    Names the size that is not positive or does not fit the others.

Examples
--------
>>> riffler.Tool.gouge(width=8, radius=5, bevel=0.6, length=60).diameter < 10
True
)")
      .def_static("v_tool", &hand_tools::v_tool, py::arg("angle"), py::arg("width"), py::arg("bevel"),
                  py::arg("length"),
                  R"(A hand tool: two blades that meet at an angle, filled up to the rims; a parting tool.

Parameters
----------
angle : float, rad
    Between the blades.
width : float, mm
    Between the rims.
bevel : float, rad
    Between the line where the blades meet and the ground end.
length : float, mm
    From the tip to the upper end.

Returns
-------
Tool
    For poses of shape (n, 9); see `convex`.

Raises
------
ValueError
    Names the size that is not positive or does not fit the others.

Examples
--------
>>> [body.shape for body in riffler.Tool.v_tool(angle=1.0, width=8, bevel=0.6, length=60).hulls]
[(6, 3)]
)")
      .def_static("knife", &hand_tools::knife, py::arg("width"), py::arg("thickness"), py::arg("edge_angle"),
                  py::arg("length"),
                  R"(A hand tool: a blade whose edge runs up from the tip and leads in the cutting direction.

Parameters
----------
width, thickness : float, mm
    From edge to back, and across.
edge_angle : float, rad
    Between the two sides of the edge.
length : float, mm
    From the tip to the upper end; the back begins a width above the tip.

Returns
-------
Tool
    For poses of shape (n, 9); see `convex`.

Raises
------
ValueError
    Names the size that is not positive or does not fit the others.

Examples
--------
>>> riffler.Tool.knife(width=10, thickness=2, edge_angle=0.5, length=60).length
60.0
)")
      .def_property_readonly(
          "hulls", &from_hulls,
          "The corners of each convex body of a hand tool, mm: arrays of shape (k, 3). Empty for tools of revolution.");
}

}  // namespace riffler::bindings
