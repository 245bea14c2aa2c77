// Finds the moves of a program that differ from those of the previous run.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "riffler/nc/program.hpp"
#include "verify/moves.hpp"

namespace riffler::verify {

/// The rows of a program, as far as they affect material.
struct RunRows {
  std::vector<Pose> poses;
  std::vector<std::uint32_t> tool;  ///< indices in the toolset
  std::vector<std::uint8_t> rapid;
};

struct ProgramEdit {
  std::vector<std::int64_t> before, now;  ///< rows only in the old program, and rows only in the new one
  std::int64_t tail = 0, shift = 0;       ///< old rows from `tail` on correspond to new rows `shift` further
};

/// Pairs rows by position, counted from the start or, if rows were added or removed, from both ends.
ProgramEdit edit_between(const RunRows& before, const RunRows& now);

/// Calls f(moves) with the moves of `rows` in batches that need little memory. `shapes` and `top` as for Moves.
void for_moves_of(const RunRows& program, std::span<const std::int64_t> rows, std::span<const ToolShapes> shapes,
                  double top, const std::function<void(const Moves&)>& f);

}  // namespace riffler::verify
