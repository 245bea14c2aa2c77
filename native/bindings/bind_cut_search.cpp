// riffler.Program.rows_at: which row made a surface.
#include "bindings/program_arguments.hpp"
#include "bindings/task.hpp"
#include "verify/row_search.hpp"

namespace riffler::bindings {

namespace {

auto rows_at(const std::shared_ptr<nc::Program>& program, const Doubles& points, const ToolsLike& tools,
             double tolerance, const ProgressLike& progress) {
  const auto work = [program, places = to_vec3s(points, "points"), own = to_tools(tools, 0),
                     tolerance](const Progress& listener) {
    return verify::row_search(*program, own, tolerance).find(places, listener);
  };
  return long_call(progress, work,
                   [](std::vector<std::int32_t>&& found) { return take<std::int32_t>(std::move(found)); });
}

}  // namespace

void bind_cut_search(py::module_& m) {
  program_class(m).def("rows_at", &rows_at, py::arg("points"), py::kw_only(), py::arg("tools") = py::none(),
                       py::arg("tolerance") = 0.05, py::arg("progress") = py::none(),
                       R"(The row that made the surface at each point.

The swept bodies of all moves are searched; nothing has to be stored while cutting. ``program.line`` and ``program.tool`` of
the rows are the lines and tools that made a surface.

Parameters
----------
points : array_like, shape (n, 3)
    mm: points on the surface that the program leaves, such as vertices of its mesh.
tools : dict, optional
    Number to Tool; takes the place of the program's own.
tolerance : float
    mm that a point may be off the surface; a quarter of the pitch fits vertices of a mesh.
progress : callable, optional
    Called with the finished share; returning False cancels.

Returns
-------
ndarray, shape (n,)
    The row whose move swept along the point, the first if several did; -1 where none did: the stock's own surface.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=6, length=30)
>>> program = riffler.Program([(0, 0, 8, 0, 0, 1), (20, 0, 8, 0, 0, 1), (20, 9, 8, 0, 0, 1)], 600, tools={1: ball})
>>> program.rows_at([(10, 0, 8), (20, 5, 8), (10, 20, 10)])
array([ 1,  2, -1], dtype=int32)
)");
}

}  // namespace riffler::bindings
