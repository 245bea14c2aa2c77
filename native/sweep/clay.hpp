// Carving that puts material on, or that leaves protected places as they are.
#pragma once

#include <span>

#include "geom/pose.hpp"
#include "sweep/carve_options.hpp"
#include "tool/tool.hpp"

namespace riffler {

/// carve().
using PlainCarve = Cut(Volume&, const Tool&, std::span<const Pose>, const CarveOptions&);

/// `carve` for options with CarveMode::Add or `protect`; poses and options have been checked. To put material on is to
/// carve the air in the box, so both modes have the same errors, forces and guarantees.
Cut carve_clay(Volume& volume, const Tool& tool, std::span<const Pose> poses, const CarveOptions& options,
               PlainCarve& carve);

}  // namespace riffler
