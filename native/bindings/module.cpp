// The extension module riffler._core. Not public: the names that riffler exports are.
#include "bindings/bindings.hpp"
#include "bindings/brush_names.hpp"
#include "bindings/history_class.hpp"
#include "bindings/program_arguments.hpp"
#include "bindings/session_frame.hpp"
#include "bindings/surface_class.hpp"

PYBIND11_MODULE(_core, m) {
  using namespace riffler;
  m.attr("__version__") = RIFFLER_VERSION;
#ifdef __clang__
  m.attr("__compiler__") = __VERSION__;
#else
  m.attr("__compiler__") = "GCC " __VERSION__;
#endif
  bindings::bind_errors(m);
  bindings::bind_tasks(m);
  bindings::bind_files(m);
  bindings::bind_mesh(m);
  bindings::bind_surface(m);
  bindings::bind_tool(m);
  bindings::bind_volume(m);
  bindings::bind_smooth_dabs(m);
  bindings::bind_brush_dabs(m);
  bindings::bind_history(m);
  bindings::bind_mesher(m);
  bindings::bind_collide(m);
  bindings::bind_machines(m);
  bindings::bind_nc_types(m);
  bindings::bind_program(m);
  bindings::bind_nc(m);
  bindings::bind_program_paths(m);
  bindings::bind_program_file(m);
  bindings::bind_cut_search(m);
  bindings::bind_verify(m);
  bindings::bind_cluster(m);
  bindings::bind_pen(m);
  bindings::bind_pen_device(m);
  bindings::bind_journal(m);
  bindings::bind_material(m);
  bindings::bind_session_frame(m);
  bindings::bind_session(m);
  bindings::bind_path(m);
  bindings::bind_orient(m);
  bindings::bind_pencil(m);
  bindings::bind_strategies(m);
  bindings::bind_plan(m);
  bindings::bind_operations(m);
  bindings::refuse_objects_without_init(m);
  bindings::answer_misfits(m);
}
