// What Session.frame and Session.stop return.
#pragma once

#include "bindings/bindings.hpp"
#include "riffler/session/session.hpp"

namespace riffler::bindings {

void bind_material(py::module_& m);
void bind_session_frame(py::module_& m);
/// After the paths.
void bind_orient(py::module_& m);

/// Rows of the ticks of a frame, and the newest tick that there was.
struct FrameView {
  session::SessionFrame frame;
  session::SculptTick last;
};

}  // namespace riffler::bindings
