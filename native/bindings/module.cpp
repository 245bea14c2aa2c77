// The extension module riffler._core. Not public: the names that riffler exports are.
#include "bindings/bindings.hpp"

PYBIND11_MODULE(_core, m) {
  using namespace riffler;
  m.attr("__version__") = RIFFLER_VERSION;
#ifdef __clang__
  m.attr("__compiler__") = __VERSION__;
#else
  m.attr("__compiler__") = "GCC " __VERSION__;
#endif
  bind_errors(m);
  bind_tasks(m);
  bind_files(m);
  bind_mesh(m);
  bind_tool(m);
  bind_volume(m);
  bind_smooth_dabs(m);
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
  refuse_objects_without_init(m);
}
