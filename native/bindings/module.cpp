// The extension module riffler._core. Not public: the names that riffler exports are.
#include "bindings/bindings.hpp"
#include "geom/error.hpp"

PYBIND11_MODULE(_core, m) {
  using namespace riffler;
  m.attr("__version__") = RIFFLER_VERSION;
#ifdef __clang__
  m.attr("__compiler__") = __VERSION__;
#else
  m.attr("__compiler__") = "GCC " __VERSION__;
#endif
  py::register_exception<FormatError>(m, "FormatError", PyExc_ValueError).attr("__doc__") =
      "A file that is not what it should be: names the file, the line or byte, and what was expected.";
  py::register_exception<Cancelled>(m, "Cancelled", PyExc_RuntimeError).attr("__doc__") =
      "A long call that its progress callback stopped; the object is as it was before.";
  bind_tasks(m);
  bind_mesh(m);
  bind_tool(m);
  bind_volume(m);
  bind_soften(m);
  bind_mesher(m);
  bind_collide(m);
  bind_program(m);
  bind_program_file(m);
  bind_verify(m);
  bind_cluster(m);
  bind_pen(m);
  bind_pen_device(m);
  bind_journal(m);
  bind_session(m);
  bind_path(m);
  bind_pencil(m);
  bind_strategies(m);
  bind_plan(m);
  bind_bench(m);
}
