// riffler.Surface.
#pragma once

#include "bindings/bindings.hpp"

namespace riffler::bindings {

void bind_surface(py::module_& m);

}  // namespace riffler::bindings
