// What a program becomes for a machine: blocks, and what happens between them. The posts write it down.
#pragma once

#include "nc/machine/machine.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::nc {

/// One block.
struct PostBlock {
  Pose pose;
  Joints joints{};
  bool rapid = false;
  bool inverse = false;  ///< takes `minutes`, whatever way its words go
  double feed = 0;       ///< mm/min at the tip; of rapids nothing
  double minutes = 0;
  bool must = false;  ///< a row ends here: written even where nothing moves
};

/// An arc in a plane of two linear axes, or a helix on it.
struct PostArc {
  PostBlock end;
  std::size_t normal = 2;  ///< axis across its plane: 2 for XY (G17), 1 for ZX (G18), 0 for YZ (G19)
  Vec3 from{0}, centre{0};
  bool clockwise = false;  ///< seen from the positive end of that axis
};

/// Takes the blocks of a program in their order.
class BlockSink {
 public:
  virtual ~BlockSink() = default;

  /// `shape` is null where it is not known.
  virtual void change_tool(int number, const Tool* shape, bool first) = 0;
  /// rev/min; > 0 clockwise, 0 stopped.
  virtual void spindle(double speed) = 0;
  /// After a change, when tool and spindle stand as they should.
  virtual void ready(int tool) = 0;
  virtual void block(const PostBlock& block) = 0;
  virtual void arc(const PostArc& arc) = 0;
};

}  // namespace riffler::nc
