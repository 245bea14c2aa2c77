// Brushes in Python, and the names of brushes and falloffs.
#pragma once

#include <string>

#include "bindings/bindings.hpp"
#include "riffler/brush/options.hpp"

namespace riffler::bindings {

/// riffler.Volume.brush and what belongs to it.
void bind_brush_dabs(py::module_& m);

const char* brush_name(brush::Kind kind);
const char* falloff_name(brush::Falloff falloff);
/// ValueError that lists the names.
brush::Kind to_brush(const std::string& name);
brush::Falloff to_falloff(const std::string& name);

}  // namespace riffler::bindings
