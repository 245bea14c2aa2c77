// A program whose swings of rotary axes are rows: for those who follow every motion from row to row.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// Which row of a program a row of the followed one belongs to: via poses to the row that they lead to.
class RowMap {
 public:
  /// Row `row` has `count` via poses. Rows ascend.
  void add(std::size_t row, std::size_t count);
  bool empty() const { return ends_.empty(); }
  std::size_t original(std::size_t followed) const;
  /// What belongs to the rows of the followed program, added up for those of the program.
  std::vector<double> sums(const std::vector<double>& followed) const;

 private:
  /// Of each row with via poses: its number in the followed program, and how many via poses there are up to it.
  std::vector<std::pair<std::size_t, std::size_t>> ends_;
};

/// Of a program that comes in chunks: each after the first begins with the row at which the one before ended.
class FollowedChunks {
 public:
  /// The chunk with its via poses as rows; what is counted of it counts once it is `taken`.
  const Program& follow(const Program& chunk);
  void taken();
  const RowMap& map() const { return map_; }

 private:
  RowMap map_, next_map_;
  std::size_t rows_ = 0, next_rows_ = 0;
  Program whole_;
};

/// `program` with its via poses as rows of their own, which have the line, feed and tool of the row that they lead to.
/// `map`, if given, takes its rows; they are counted from `first_row` on.
Program followed(const Program& program, RowMap* map = nullptr, std::size_t first_row = 0);

}  // namespace riffler::nc
