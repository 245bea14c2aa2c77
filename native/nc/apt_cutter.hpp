// CUTTER/… of APT files, the seven-parameter cutter: in both directions by the table of shapes.
#pragma once

#include <optional>
#include <vector>

#include "nc/source.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::nc {

/// The tool of up to seven numbers d, r, e, f, a, b, h (lengths in `unit` mm, angles in degrees). Nothing where no
/// shape of the table matches, and where the length is missing. FormatError for sizes that make no tool.
std::optional<Tool> apt_cutter(std::vector<double> numbers, double unit, const NcPlace& place);

/// The statement of a tool, or nothing where seven numbers cannot describe its shape.
std::optional<tool::AptCutter> to_apt(const Tool& tool);

}  // namespace riffler::nc
