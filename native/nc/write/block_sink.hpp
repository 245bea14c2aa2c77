// A program as blocks of a machine with the events between them; the posts write it as text.
#pragma once

#include "nc/machine/machine.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::nc {

/// One block.
struct PostBlock {
  Pose pose;
  Joints joints{};
  bool rapid = false;
  bool inverse = false;  ///< takes `minutes`, independent of its words' path
  double feed = 0;       ///< mm/min at the tip; no meaning for rapids
  double minutes = 0;
  bool must = false;  ///< a row ends here: written even without motion
};

/// An arc in a plane of two linear axes, or a helix on it.
struct PostArc {
  PostBlock end;
  std::size_t normal = 2;  ///< axis normal to its plane: 2 for XY (G17), 1 for ZX (G18), 0 for YZ (G19)
  Vec3 from{0}, centre{0};
  bool clockwise = false;  ///< seen from the positive end of that axis
};

/// Receives the blocks of a program in order.
class BlockSink {
 public:
  virtual ~BlockSink() = default;

  /// `shape`: null if unknown. `first`: before the first block.
  virtual void change_tool(int number, const Tool* shape, bool first) = 0;
  /// rev/min; > 0 clockwise, 0 stopped.
  virtual void spindle(double speed) = 0;
  /// After a change, when tool and spindle are ready.
  virtual void ready(int tool) = 0;
  virtual void block(const PostBlock& block) = 0;
  virtual void arc(const PostArc& arc) = 0;
};

}  // namespace riffler::nc
