// riffler.Program.from_cl: programs from cutter locations.
#include <functional>
#include <optional>

#include "bindings/program_arguments.hpp"
#include "riffler/nc/cutter_path.hpp"

namespace riffler::bindings {

namespace {

/// The tool's number for every path: one tool for all or one each; equal tools share a number. A dict keeps its
/// numbers.
std::vector<int> number_tools(const ToolListLike& object, std::size_t paths, std::map<int, Tool>& tools) {
  if (object.is_none()) return std::vector<int>(paths, 1);
  std::vector<py::object> list;
  for (const py::handle& tool : object) {
    if (!py::isinstance<Tool>(tool)) throw py::value_error("tools must be a list of Tool");
    list.push_back(py::reinterpret_borrow<py::object>(tool));
  }
  if (list.size() != 1 && list.size() != paths)
    throw py::value_error("tools must be one for all arrays or one for each: " + std::to_string(paths) + ", not " +
                          std::to_string(list.size()));
  std::vector<py::object> different;
  std::vector<int> numbers;
  for (const py::object& tool : list) {
    std::size_t k = 0;
    while (k < different.size() && !different[k].equal(tool)) ++k;
    if (k == different.size()) {
      py::cast<const Tool&>(tool).require_revolved("tools: a program");
      different.push_back(tool);
      tools.emplace(static_cast<int>(k) + 1, py::cast<const Tool&>(tool));
    }
    numbers.push_back(static_cast<int>(k) + 1);
  }
  if (numbers.size() < paths) numbers.assign(paths, 1);
  return numbers;
}

/// The value for path `k`: `object` itself, or its k-th entry where it is a list or tuple.
py::object for_path(const py::object& object, std::size_t k, std::size_t paths, const char* name) {
  if (!py::isinstance<py::list>(object) && !py::isinstance<py::tuple>(object)) return object;
  const auto list = py::cast<py::sequence>(object);
  if (list.size() != paths) throw py::value_error(std::string(name) + " must be one for all arrays or one for each");
  return list[k];
}

nc::Program from_cl(const ArraysLike& cl, const ToolListLike& tools, const PerPathLike& feed,
                    const PerPathLike& spindle, const std::optional<double>& safe_height, double clearance,
                    const CornersLike& occupied, const StringsLike& provenance,
                    const std::shared_ptr<collide::Collider>& collider, const std::optional<double>& retract,
                    const OptionalArrayLike& direction, const std::optional<double>& lead_in,
                    double contact_tolerance) {
  std::vector<py::object> arrays;
  for (const py::handle& array : cl) arrays.push_back(py::reinterpret_borrow<py::object>(array));
  std::map<int, Tool> by_number;
  const std::vector<int> numbers = number_tools(tools, arrays.size(), by_number);
  std::vector<nc::CutterPath> paths;
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    const std::string name = "cl[" + std::to_string(k) + "]";
    nc::CutterPath path;
    path.poses = to_poses(to_doubles(arrays[k], name), name.c_str());
    path.feed = to_column(for_path(feed, k, arrays.size(), "feed"), path.poses.size(), "feed", false);
    path.spindle = to_column(for_path(spindle, k, arrays.size(), "spindle"), 1, "spindle")[0];
    path.tool = numbers[k];
    paths.push_back(std::move(path));
  }
  nc::Clearance room{safe_height, clearance, {}};
  if (!occupied.is_none()) {
    const auto box = py::cast<std::pair<py::object, py::object>>(occupied);
    room.occupied = {to_vec3(box.first, "occupied lower"), to_vec3(box.second, "occupied upper")};
  }
  nc::LinkRule links{collider.get(), contact_tolerance, retract, {}, lead_in};
  if (!direction.is_none()) links.direction = to_vec3(direction, "direction");
  if (!collider && (links.retract || links.direction))
    throw py::value_error("retract and direction choose among checked links: they need a collider");
  const nc::Provenance origin = to_provenance(provenance);
  const NoGil release;
  nc::Program program = program_from_paths(paths, std::move(by_number), room, links);
  program.provenance = origin;
  return program;
}

}  // namespace

void bind_program_paths(py::module_& m) {
  program_class(m).def_static(
      "from_cl", &from_cl, py::arg("cl"), py::arg("tools"), py::kw_only(), py::arg("feed"), py::arg("spindle") = 0.0,
      py::arg("safe_height") = py::none(), py::arg("clearance") = 10.0, py::arg("occupied") = py::none(),
      py::arg("provenance") = py::none(), py::arg("collider") = py::none(), py::arg("retract") = py::none(),
      py::arg("direction") = py::none(), py::arg("lead_in") = py::none(), py::arg("contact_tolerance") = 0.02,
      R"(A program from cutter locations: every (n, 6) array is one cut.

Its rows become feed moves in order, none merged. Before a cut there is a rapid at safe height to above its first point,
along the tool's axis, and the feed in; after it a rapid out along the axis. With a ``collider``, approaches, retracts and
the moves between cuts are resolved with cutter, shank and holder: along the tool's axis where that is clear, otherwise by
another link, the axis unchanged; such a link is fed, since it may cross stock.

Parameters
----------
cl : list of array_like, shape (n, 6)
    Tip in mm and unit axis, as ``riffler.plan.cutter_locations`` returns them.
tools : list of Tool, or None
    One for all arrays or one for each; None: tool 1 of unknown shape.
feed : float or array_like, or a list of one for each array
    mm/min at the tip; an array has one for each row.
spindle : float, or a list of one for each array
    rev/min; negative counter-clockwise.
safe_height : float, optional
    z (mm) above everything; None: ``clearance`` above all tips and ``occupied``.
clearance : float
    mm.
occupied : tuple of two array_like, shape (3,), optional
    Corners of a box around stock, part and fixtures, mm. Part and fixtures of ``collider`` are occupied, too.
provenance : dict, optional
    Strings for the header comment.
collider : Collider, optional
    Part and fixtures.
retract : float, optional
    mm of the first stretch out of a cut; None: searches a clear one.
direction : array_like, shape (3,), optional
    Unit vector of that stretch; None: likewise.
lead_in : float, optional
    mm before a cut at feed, if everything above is air; None: the whole approach at feed.
contact_tolerance : float
    mm by which a tool may enter part and fixtures, as cuts touch the part.

Returns
-------
Program

Raises
------
ValueError
    Naming the path, the row, the place and the remedy if no link is clear.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=6, length=30)
>>> cut = [(0, 0, 0, 0, 0, 1), (20, 0, 0, 0, 0, 1)]
>>> program = riffler.Program.from_cl([cut], [ball], feed=600, spindle=12000)
>>> int((~program.rapid).sum()), program.tools[1] == ball
(2, True)
)");
}

}  // namespace riffler::bindings
