// Programs made from programs.
#pragma once

#include <map>
#include <span>

#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// Rows [first, last). The first of them is a rapid: the way to it is not the program's any more.
/// std::invalid_argument where there are no such rows.
Program trimmed(const Program& program, std::size_t first, std::size_t last);

/// Turned, then moved (mm): another clamping. `turn` must be a rotation within 1e-9, otherwise std::invalid_argument.
Program transformed(const Program& program, const Mat3& turn, const Vec3& shift);

/// Feeds times `factor`, which must be positive and finite; rapids as they are.
Program scale_feeds(const Program& program, double factor);

/// One after the other: the way from one's last row to the next one's first is as that row says. Of provenance that
/// several have the first stays. std::invalid_argument where one number stands for tools of two shapes.
Program joined(std::span<const Program* const> programs);

/// Tool numbers by `numbers`; those that are not in it stay. std::invalid_argument naming a number that is not positive
/// or that two tools of different shapes would have.
Program renumber_tools(const Program& program, const std::map<int, int>& numbers);

}  // namespace riffler::nc
