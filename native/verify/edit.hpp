// Which moves of a program differ from those of the one that was run before.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "riffler/nc/program.hpp"
#include "verify/moves.hpp"

namespace riffler::verify {

/// What of a program decides what happens to material.
struct RunRows {
  std::vector<Pose> poses;
  std::vector<std::uint32_t> tool;  ///< places in the toolset
  std::vector<std::uint8_t> rapid;
};

struct ProgramEdit {
  std::vector<std::int64_t> before, now;  ///< rows of the old and of the new program that the other one does not have
  std::int64_t tail = 0, shift = 0;       ///< rows of the old one from `tail` on are `shift` further in the new one
};

/// Rows at the same place, counted from the start or, if there are more or fewer of them now, from both ends.
ProgramEdit edit_between(const RunRows& before, const RunRows& now);

/// Calls f(moves) with the moves of `rows` in stretches that take little memory. `shapes` and `top` as for Moves.
void for_moves_of(const RunRows& program, std::span<const std::int64_t> rows, std::span<const ToolShapes> shapes,
                  double top, const std::function<void(const Moves&)>& f);

}  // namespace riffler::verify
