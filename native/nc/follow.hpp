// Converts via poses into rows, for code that follows every motion from row to row.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// Maps the rows of a followed program to those of the original: via poses belong to the row they lead to.
class RowMap {
 public:
  /// Row `row` has `count` via poses. Call it with ascending rows.
  void add(std::size_t row, std::size_t count);
  bool empty() const { return ends_.empty(); }
  std::size_t original(std::size_t followed) const;
  /// Sums per-row values of the followed program into rows of the original.
  std::vector<double> sums(const std::vector<double>& followed) const;

 private:
  /// Per row with via poses: its index in the followed program, and the number of via poses up to it.
  std::vector<std::pair<std::size_t, std::size_t>> ends_;
};

/// Follows a program that arrives in chunks: each after the first begins with the last row of the one before.
class FollowedChunks {
 public:
  /// The chunk with its via poses as rows. Its counts are added when it is `taken`.
  const Program& follow(const Program& chunk);
  void taken();
  const RowMap& map() const { return map_; }

 private:
  RowMap map_, next_map_;
  std::size_t rows_ = 0, next_rows_ = 0;
  Program whole_;
};

/// `program` with its via poses as rows, which take line, feed and tool of the row they lead to. `map`, if not null,
/// receives the rows, counted from `first_row`.
Program followed(const Program& program, RowMap* map = nullptr, std::size_t first_row = 0);

}  // namespace riffler::nc
