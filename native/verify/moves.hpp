// Moves to be simulated, with bounding boxes that decide which slabs they can touch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "riffler/geom/pose.hpp"
#include "verify/shapes.hpp"

namespace riffler::verify {

/// Marks moves without a tool that could collide.
inline constexpr std::uint32_t kNoTool = ~0U;

/// Columns with one entry per move. Rows ascend.
class Moves {
 public:
  /// `stride` 1: poses of a path, move i from poses[i] to poses[i + 1]; 2: pairs of poses, moves that need not connect.
  /// `tool`: indices in `shapes`, or kNoTool. Arguments must outlive this object. There is no material above z = `top`
  /// (mm).
  Moves(std::span<const Pose> poses, std::uint32_t stride, std::span<const ToolShapes> shapes, double top);
  void add(std::int64_t row, std::uint32_t tool, bool rapid) {
    row_.push_back(row), tool_.push_back(tool), rapid_.push_back(rapid);
  }
  /// Computes the boxes once all moves are there.
  void finish();

  std::size_t size() const { return row_.size(); }
  std::span<const Pose> poses() const { return poses_; }
  std::uint32_t end(std::size_t i) const { return static_cast<std::uint32_t>(i) * stride_ + 1; }
  const Pose& from(std::size_t i) const { return poses_[end(i) - 1]; }
  const Pose& to(std::size_t i) const { return poses_[end(i)]; }
  std::int64_t row(std::size_t i) const { return row_[i]; }
  std::uint32_t tool(std::size_t i) const { return tool_[i]; }
  bool rapid(std::size_t i) const { return rapid_[i] != 0; }
  const ToolShapes& shapes(std::size_t i) const { return shapes_[tool_[i]]; }
  Box3 swept(const Rod& rod, std::size_t i) const { return rod.swept(from(i), to(i), top_); }

  /// Parts of the tool that could touch a box.
  enum Touch : unsigned char { None = 0, Cutter = 1, Probes = 2, Whole = 3 };
  Touch touch(std::size_t i, const Box3& box) const;
  /// Calls f(i, touch) in order for every move from `first` on that could touch the box.
  template <class F>
  void for_each(std::size_t first, const Box3& box, const F& f) const {
    for (std::size_t i = first; i < size(); ++i) {
      if (i % kBlock == 0 || i == first)
        if (!blocks_[i / kBlock].overlaps(box)) {
          i = (i / kBlock + 1) * kBlock - 1;
          continue;
        }
      if (const Touch t = touch(i, box); t != None) f(i, t);
    }
  }

 private:
  static constexpr std::size_t kBlock = 64;
  std::span<const Pose> poses_;
  std::uint32_t stride_;
  std::span<const ToolShapes> shapes_;
  double top_;
  std::vector<std::int64_t> row_;
  std::vector<std::uint32_t> tool_;
  std::vector<std::uint8_t> rapid_;
  std::vector<Box3> cutter_, probes_;  // per move; empty without a tool
  std::vector<Box3> blocks_;           // per kBlock moves, whole tool
};

}  // namespace riffler::verify
