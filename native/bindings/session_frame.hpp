// What the frames of both kinds of sessions have: rows of ticks, and the newest tick. Session.frame, Session.stop and
// those of OrientSession return them.
#pragma once

#include "bindings/bindings.hpp"
#include "riffler/session/orient_session.hpp"
#include "riffler/session/session.hpp"

namespace riffler::bindings {

void bind_material(py::module_& m);
void bind_session_frame(py::module_& m);
/// After the paths.
void bind_orient(py::module_& m);

/// Rows of the ticks of a frame, and the newest tick that there was.
template <class Frame, class Tick>
struct FrameOf {
  using TickType = Tick;

  Frame frame;
  Tick last;
};

using FrameView = FrameOf<session::SessionFrame, session::SculptTick>;
using OrientView = FrameOf<session::OrientFrame, session::OrientTick>;

/// One value of `get` per tick, as rows of `columns` numbers, or as a column for 0.
template <std::size_t columns = 0, class F, class Get>
py::array_t<double> rows(const F& f, const Get& get) {
  std::vector<std::invoke_result_t<Get, const typename F::TickType&>> out;
  out.reserve(f.frame.ticks.size());
  for (const typename F::TickType& tick : f.frame.ticks) out.push_back(get(tick));
  return take<double>(std::move(out), columns);
}

/// What differs in the documentation of the properties that all frames have.
struct FrameWords {
  const char *tool_forces, *depth, *problem;
};

/// Adds the properties that all frames have to their class. `F`: FrameView or OrientView.
template <class F>
void bind_ticks(py::class_<F>& c, const FrameWords& words) {
  using T = typename F::TickType;
  c.def_property_readonly(
       "times", [](const F& f) { return rows(f, [](const T& t) { return t.time; }); }, "(n,) s since the start.")
      .def_property_readonly(
          "poses", [](const F& f) { return rows<6>(f, [](const T& t) { return t.tool; }); },
          "(n, 6) of the tool, at each step's end.")
      .def_property_readonly(
          "grips", [](const F& f) { return rows<6>(f, [](const T& t) { return t.grip; }); },
          "(n, 6) of the grip, in the device's frame.")
      .def_property_readonly(
          "forces", [](const F& f) { return rows<6>(f, [](const T& t) { return t.wrench; }); },
          "(n, 6): force (N) and torque (N·mm), as sent to the device.")
      .def_property_readonly(
          "energy", [](const F& f) { return rows(f, [](const T& t) { return t.energy; }); },
          "(n,) N·mm: the passivity account, the energy that may still go to the hand.")
      .def_property_readonly(
          "step_seconds", [](const F& f) { return rows(f, [](const T& t) { return t.seconds; }); },
          "(n,) s of processor time.")
      .def_property_readonly(
          "missed", [](const F& f) { return rows(f, [](const T& t) { return t.missed ? 1.0 : 0.0; }); },
          "(n,) 1 where a step was missed and the last force was held.")
      .def_property_readonly(
          "held", [](const F& f) { return rows(f, [](const T& t) { return t.held ? 1.0 : 0.0; }); },
          "(n,) 1 where the tool did not move, because its depth in the obstacles was not found in time.")
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
          "Why the force was removed and what to do, or None.")
      .def_property_readonly(
          "dropped_ticks", [](const F& f) { return f.frame.dropped_ticks; },
          "Steps since the start that are missing in all frames because frames were too rare; 4096 are kept.")
      .def_property_readonly(
          "tool_forces", [](const F& f) { return rows<6>(f, [](const T& t) { return t.on_tool; }); }, words.tool_forces)
      .def_property_readonly(
          "depth", [](const F& f) { return rows(f, [](const T& t) { return t.depth; }); }, words.depth)
      .def_property_readonly(
          "problem",
          [](const F& f) -> std::optional<std::string> {
            if (!f.last.problem) return {};
            return f.last.problem;
          },
          words.problem)
      .def("__len__", [](const F& f) { return f.frame.ticks.size(); });
}

}  // namespace riffler::bindings
