// The seven-parameter cutter of APT files, CUTTER/…, in both directions by the table of shapes.
#pragma once

#include <optional>
#include <vector>

#include "nc/source.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::nc {

/// The tool of up to seven numbers d, r, e, f, a, b, h (lengths in `unit` mm, angles in degrees). No value if no shape
/// of the table matches or the length is missing. Throws FormatError for sizes that make no tool.
std::optional<Tool> apt_cutter(std::vector<double> numbers, double unit, const NcPlace& place);

/// The statement of a tool; no value if seven numbers cannot describe its shape.
std::optional<tool::AptCutter> to_apt(const Tool& tool);

}  // namespace riffler::nc
