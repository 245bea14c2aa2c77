// CUTTER/… of APT files: the seven-parameter cutter.
#pragma once

#include <optional>
#include <vector>

#include "nc/source.hpp"
#include "tool/tool.hpp"

namespace riffler {

/// Of up to seven numbers d, r, e, f, a, b, h (lengths in `unit` mm, angles in degrees): flat, ball and fillet ends and
/// cones that end in a ball are shapes of ours; nothing for others, and where the height is missing. FormatError for
/// sizes that make no tool.
std::optional<Tool> apt_cutter(std::vector<double> numbers, double unit, const NcPlace& place);

}  // namespace riffler
