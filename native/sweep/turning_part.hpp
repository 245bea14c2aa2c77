// A convex part of a tool on a short part of a move that turns its axis: what the kernel needs, in plain numbers.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geom/pose.hpp"
#include "tool/piece.hpp"

namespace riffler {

/// Frustum or Round (piece.hpp) in numbers; all fields are set for both, unless they say otherwise.
struct PieceShape {
  bool round, ball;             ///< ball: a Round that is a whole ball
  double z0, r0, z1, r1;        ///< ends
  double slope, cosine;         ///< Frustum: dr/dz and 1 / √(1 + slope²)
  double e, zc, r;              ///< Round
};

/// The tool at one t. Frame: e1 × e2 = axis, the rays in the plane of axis and e1: their direction is tilt e1 + oz axis.
struct PoseFrame {
  double t;
  double tip[3], e1[3], e2[3], axis[3];
  double tilt, oz;
  double way[3], spin[3];  ///< velocity of the tip and rotation, per unit of t, in the frame; spin[2] = 0
};

/// Pieces whose union is convex, from the tip upwards.
struct ConvexGroup {
  static constexpr std::size_t kMost = 4;
  std::array<Piece, kMost> pieces;
  std::size_t count = 0;
  std::span<const Piece> all() const { return {pieces.data(), count}; }
};

/// Splits pieces, from the tip upwards, into groups whose unions are convex.
std::vector<ConvexGroup> convex_groups(std::span<const Piece> pieces);

/// The poses at which the kernel asks, made when first asked for, and what bounds the motion between them.
class TurningPoses {
 public:
  /// [t0, t1] is halved at most this often.
  static constexpr int kDeepest = 24;
  static constexpr std::uint32_t kEnd = 1U << kDeepest;

  TurningPoses(const ConvexGroup& group, const Motion& motion, double t0, double t1, double tolerance);

  std::size_t count() const { return count_; }
  const PieceShape& piece(std::size_t k) const { return pieces_[k]; }
  /// The pose at t0 + (t1 − t0) · place / kEnd. `spare` holds it if it is not one of those that are kept.
  const PoseFrame& at(std::uint32_t place, PoseFrame& spare);

  double duration() const { return t1_ - t0_; }
  double origin() const { return origin_; }      ///< heights on the ray count from here
  double along() const { return along_; }        ///< mm along the ray that an end may miss
  double aside() const { return aside_; }        ///< mm in space that a supporting plane may be behind
  double spin2() const { return spin2_; }        ///< |Ω|²
  double coriolis() const { return coriolis_; }  ///< 2 |Ω × V|
  double way() const { return way_; }            ///< |V|
  int deepest() const { return deepest_; }       ///< halvings after which no point moves more than `aside`
  const double* tip_from() const { return tip_from_; }
  const double* tip_way() const { return tip_way_; }
  const double* rotation() const { return rotation_; }
  const double* axis() const { return axis_; }  ///< in the middle of the part

 private:
  static constexpr int kKept = 5;  // halvings whose poses are kept
  PoseFrame make(double t) const;

  std::array<PieceShape, ConvexGroup::kMost> pieces_;
  std::size_t count_;
  const Motion& motion_;
  double t0_, t1_, origin_, along_, aside_, spin2_, coriolis_, way_;
  int deepest_;
  double tip_from_[3], tip_way_[3], rotation_[3], axis_[3];
  std::uint64_t have_ = 0;
  PoseFrame kept_[(1 << kKept) + 1];
};

/// Unit normal, out of the group, where the sweep has its boundary at p at time t.
Vec3 turning_normal(const ConvexGroup& group, const Motion& motion, const Vec3& p, double t);

}  // namespace riffler
