// riffler.SessionFrame
#include "bindings/bindings.hpp"
#include "bindings/session_frame.hpp"

namespace riffler::bindings {

void bind_session_frame(py::module_& m) {
  using F = FrameView;
  using T = session::SculptTick;
  py::class_<F> c(m, "SessionFrame",
                  R"(The steps between two calls of ``Session.frame``, one row for each: see `Session.frame`.

Forces and torques act on the hand, about the grip's point, in the device's frame; those on the tool act on it, about its
tip, in the part's.)");
  c.def_property_readonly(
       "tiles",
       [](const F& f) {
         std::vector<std::int32_t> out;
         for (const auto& p : f.frame.tiles)
           out.insert(out.end(), {static_cast<std::int32_t>(p.grid), static_cast<std::int32_t>(p.tile)});
         return take<std::int32_t>(std::move(out), 2);
       },
       "(k, 2): number of the grid and of the tile in it, for each tile that changed.")
      .def_property_readonly(
          "starts", [](const F& f) { return rows<6>(f, [](const T& t) { return t.from; }); },
          "(n, 6) of the tool, at the start of each step; differs from the pose before after a new placement.")
      .def_property_readonly(
          "applied", [](const F& f) { return rows<6>(f, [](const T& t) { return t.applied; }); },
          "(n, 6): as applied, if the device reports it; otherwise as sent one step before.")
      .def_property_readonly(
          "removed", [](const F& f) { return rows(f, [](const T& t) { return t.removed; }); },
          "(n,) mm³ removed; added in a session that adds.")
      .def_property_readonly(
          "dt", [](const F& f) { return rows(f, [](const T& t) { return t.dt; }); }, "(n,) s from step to step.")
      .def_property_readonly(
          "cutting", [](const F& f) { return rows(f, [](const T& t) { return t.cutting ? 1.0 : 0.0; }); },
          "(n,) 1 in strokes, otherwise 0.")
      .def_property_readonly(
          "strokes", [](const F& f) { return f.frame.strokes; }, "Number of strokes begun since the start.")
      .def_property_readonly(
          "in_stroke", [](const F& f) { return f.frame.in_stroke; },
          "Whether a stroke was in progress when the loop handed over the frame's tiles.");
  bind_ticks(c, {"(n, 6): force (N) and torque (N·mm) of the material on the tool, before limits.",
                 "(n,) mm: largest depth of the tool in what it must not enter.",
                 "Why the tool does not cut although the hand asks for it, or None."});
}

}  // namespace riffler::bindings
