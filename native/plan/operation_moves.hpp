// What operations share: the frame that they are planned in, and the writing of their moves.
#pragma once

#include <vector>

#include "riffler/plan/operation.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Height above the stock at which a rapid down ends, mm.
inline constexpr double kAbove = 1;

/// A frame with z along the tool's axis, its x turned by `angle` (rad). Columns are its axes.
Mat3 operation_frame(const Vec3& axis, double angle);

/// A set-up in such a frame.
struct TurnedScene {
  Mat3 frame;
  Mesh part;
  std::vector<Mesh> fixtures;
  double plane;  ///< z of the clearance plane: above part, fixtures and the stock's box
};

/// Throws std::invalid_argument for a part without triangles, a bad mesh, or a clearance that is not positive.
TurnedScene turned(const SetupScene& scene, double angle);

/// The surface of the set-up's stock in a frame.
Mesh turned_stock(const SetupScene& scene, const Mat3& frame);

/// The triangles of the part, followed by those of the fixtures, as one mesh.
Mesh joined(const Mesh& part, const std::vector<Mesh>& fixtures);

/// Throws std::invalid_argument, which names what needs it, for a cutter that narrows above its widest place.
void require_upright_cutter(const Tool& tool, const char* work);

/// Appends moves, given in the frame, to an operation.
class MoveWriter {
 public:
  /// `feed`: of cuts and links, `plunge`: of leads, mm/min. Keeps references.
  MoveWriter(Operation& out, const Mat3& frame, double feed, double plunge)
      : out_(out), frame_(frame), feed_(feed), plunge_(plunge) {}

  void to(const Vec3& tip, MoveKind kind);
  /// Rapid moves over the clearance plane and down to `height` over `tip`, then a lead to it.
  void approach(const Vec3& tip, double plane, double height);
  /// A rapid move up to the clearance plane.
  void retract(double plane) { to({last_.x, last_.y, plane}, MoveKind::Rapid); }
  const Vec3& last() const { return last_; }

 private:
  Operation& out_;
  const Mat3& frame_;
  double feed_, plunge_;
  Vec3 last_{0};
};

}  // namespace riffler::plan
