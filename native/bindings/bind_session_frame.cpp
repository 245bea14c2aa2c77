// riffler.SessionFrame
#include "bindings/bindings.hpp"
#include "bindings/session_frame.hpp"

namespace riffler::bindings {

namespace {

using F = FrameView;
using T = session::SculptTick;

/// One value of `get` per tick, as rows of `columns` numbers, or as a column for 0.
template <std::size_t columns = 0, class Get>
py::array_t<double> rows(const F& f, const Get& get) {
  std::vector<std::invoke_result_t<Get, const T&>> out;
  out.reserve(f.frame.ticks.size());
  for (const T& tick : f.frame.ticks) out.push_back(get(tick));
  return take<double>(std::move(out), columns);
}

}  // namespace

void bind_session_frame(py::module_& m) {
  py::class_<F>(m, "SessionFrame",
                R"(What happened between two calls of ``Session.frame``, one row for each step: see `Session.frame`.

Forces and torques act on the hand, about the grip's point, in the device's frame; those on the tool act on it, about its
tip, in the part's.)")
      .def_property_readonly(
          "tiles",
          [](const F& f) {
            std::vector<std::int32_t> out;
            for (const auto& p : f.frame.tiles)
              out.insert(out.end(), {static_cast<std::int32_t>(p.grid), static_cast<std::int32_t>(p.tile)});
            return take<std::int32_t>(std::move(out), 2);
          },
          "(k, 2): number of the grid and of the tile in it, for each tile that changed.")
      .def_property_readonly(
          "times", [](const F& f) { return rows(f, [](const T& t) { return t.time; }); }, "(n,) s since the start.")
      .def_property_readonly(
          "poses", [](const F& f) { return rows<6>(f, [](const T& t) { return t.tool; }); },
          "(n, 6) of the tool, at each step's end.")
      .def_property_readonly(
          "starts", [](const F& f) { return rows<6>(f, [](const T& t) { return t.from; }); },
          "(n, 6) of the tool, at the start of each step; differs from the pose before after a new placement.")
      .def_property_readonly(
          "grips", [](const F& f) { return rows<6>(f, [](const T& t) { return t.grip; }); },
          "(n, 6) of the grip, in the device's frame.")
      .def_property_readonly(
          "forces", [](const F& f) { return rows<6>(f, [](const T& t) { return t.wrench; }); },
          "(n, 6): force (N) and torque (N·mm), as sent to the device.")
      .def_property_readonly(
          "applied", [](const F& f) { return rows<6>(f, [](const T& t) { return t.applied; }); },
          "(n, 6): as applied, if the device reports it; otherwise as sent one step before.")
      .def_property_readonly(
          "tool_forces", [](const F& f) { return rows<6>(f, [](const T& t) { return t.on_tool; }); },
          "(n, 6): force (N) and torque (N·mm) of the material on the tool, before limits.")
      .def_property_readonly(
          "removed", [](const F& f) { return rows(f, [](const T& t) { return t.removed; }); },
          "(n,) mm³ removed; added in a session that adds.")
      .def_property_readonly(
          "energy", [](const F& f) { return rows(f, [](const T& t) { return t.energy; }); },
          "(n,) N·mm that may go to the hand: the account of passivity.")
      .def_property_readonly(
          "depth", [](const F& f) { return rows(f, [](const T& t) { return t.depth; }); },
          "(n,) mm that the tool is at most in what it must not enter.")
      .def_property_readonly(
          "step_seconds", [](const F& f) { return rows(f, [](const T& t) { return t.seconds; }); },
          "(n,) s of processor time.")
      .def_property_readonly(
          "dt", [](const F& f) { return rows(f, [](const T& t) { return t.dt; }); }, "(n,) s from step to step.")
      .def_property_readonly(
          "cutting", [](const F& f) { return rows(f, [](const T& t) { return t.cutting ? 1.0 : 0.0; }); },
          "(n,) 1 in strokes, otherwise 0.")
      .def_property_readonly(
          "missed", [](const F& f) { return rows(f, [](const T& t) { return t.missed ? 1.0 : 0.0; }); },
          "(n,) 1 where no step could be made and the force was held over.")
      .def_property_readonly(
          "tool", [](const F& f) { return from_poses({f.last.tool}).reshape({6}); }, "(6,) now.")
      .def_property_readonly(
          "grip", [](const F& f) { return from_poses({f.last.grip}).reshape({6}); }, "(6,) now.")
      .def_property_readonly(
          "force", [](const F& f) { return from_vec3(f.last.wrench.force); }, "(3,) N, now.")
      .def_property_readonly(
          "torque", [](const F& f) { return from_vec3(f.last.wrench.torque); }, "(3,) N·mm, now.")
      .def_property_readonly(
          "state", [](const F& f) { return name(f.last.state); },
          "Force state now: off, homing, ready, ramp, active, degraded or tripped.")
      .def_property_readonly(
          "cause",
          [](const F& f) -> std::optional<std::string> {
            if (f.last.cause == haptics::Cause::None) return {};
            return sentence(f.last.cause);
          },
          "Why the force was taken away and what to do, or None.")
      .def_property_readonly(
          "problem",
          [](const F& f) -> std::optional<std::string> {
            if (!f.last.problem) return {};
            return f.last.problem;
          },
          "Why nothing is cut though the hand wants to, or None.")
      .def_property_readonly(
          "strokes", [](const F& f) { return f.frame.strokes; }, "Number of strokes begun since the start.")
      .def_property_readonly("in_stroke", [](const F& f) { return f.frame.in_stroke; })
      .def_property_readonly(
          "dropped_ticks", [](const F& f) { return f.frame.dropped_ticks; },
          "Steps since the start that are in no frame, because frames were too rare: 4096 are kept.")
      .def("__len__", [](const F& f) { return f.frame.ticks.size(); });
}

}  // namespace riffler::bindings
