// Edited copies of programs.
#pragma once

#include <map>
#include <span>

#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// Rows [first, last). The first of them becomes a rapid, because the moves before it are gone. Throws
/// std::invalid_argument for rows that do not exist.
Program trimmed(const Program& program, std::size_t first, std::size_t last);

/// The program rotated by `turn`, then moved by `shift` (mm): another clamping. Throws std::invalid_argument unless
/// `turn` is a rotation within 1e-9.
Program transformed(const Program& program, const Mat3& turn, const Vec3& shift);

/// The program with feeds multiplied by `factor`, positive and finite. Rapids stay.
Program scale_feeds(const Program& program, double factor);

/// The programs in sequence. The move from one program's last row to the next one's first is of the kind that this
/// first row states. If a provenance key occurs in several, the first value stays. Throws std::invalid_argument where
/// one tool number has two different shapes.
Program joined(std::span<const Program* const> programs);

/// The program with tool numbers replaced by `numbers`; numbers not in the map stay. Throws std::invalid_argument
/// naming a new number that is not positive or that two tools of different shapes would share.
Program renumber_tools(const Program& program, const std::map<int, int>& numbers);

}  // namespace riffler::nc
