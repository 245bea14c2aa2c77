// The offset surface that finishing rows lie on, and which places of it are meant.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "riffler/plan/drop.hpp"
#include "riffler/plan/finish.hpp"

namespace riffler::plan {

/// One point of the drop surface. Coordinates are those of the rows: x along them, z along the tool's axis.
struct SurfacePoint {
  Vec3 tip{0};  ///< z is meaningless where nothing is touched
  DropCutter::Landing landing;
  bool gap = false;  ///< the row does not lead here from the point before
};

/// Curves of the drop surface over straight lines.
class FinishSurface {
 public:
  /// `part` and `fixtures` in the rows' frame.
  FinishSurface(const Mesh& part, const std::vector<Mesh>& fixtures, const Tool& tool, const FinishOptions& options,
                std::vector<std::vector<Vec2>> region);

  SurfacePoint at(const Vec2& p) const;
  /// The points over the line from `from` to `to`: straight moves between them are at most `tolerance` below the drop
  /// surface, and where it is continuous not further above it. Over a step they rise or sink upright, at most half the
  /// tolerance off it.
  std::vector<SurfacePoint> follow(const Vec2& from, const Vec2& to) const;
  /// The same over a line of several points.
  std::vector<SurfacePoint> follow(const std::vector<Vec2>& line) const;
  /// The parts of such a curve where the cutter touches faces that are meant; adds what is blocked.
  std::vector<std::vector<Vec3>> meant_pieces(const std::vector<SurfacePoint>& points,
                                              std::vector<BlockedPlace>& blocked) const;
  /// Whether the cutter touches a face that is meant there, not an edge that it rolls over.
  bool meant(const SurfacePoint& p) const { return wanted(p) && !rolls(p); }
  /// Whether a row may pass there: the cutter touches a face that is meant, or an edge.
  bool passes(const SurfacePoint& p) const { return wanted(p) || rolls(p); }
  /// The reason why the tool cannot cut at a point that it touches, or null.
  const char* blocked(const SurfacePoint& p) const;
  /// Whether faces as steep as this (rad) are meant.
  bool meant_slope(double slope) const;

  /// Whether a face is meant that the cutter touches at a point, with this slope (rad) of what it touches.
  bool wanted_face(int triangle, const Vec3& point, double slope) const;
  /// Whether the cutter touches faces of the part at two points that are turned against each other.
  bool creased(const SurfacePoint& a, const SurfacePoint& b) const;
  /// Slope (rad from level) of a triangle of the part.
  double face_slope(int triangle) const;
  /// The slope of what a cutter with a round tip touches, an edge included; else that of the face.
  double touched_slope(const SurfacePoint& p) const;
  /// The steepest slope of the part's faces that are chosen and meant; negative if there are none.
  double steepest_meant() const;

  /// How far the drop surface rises above a straight move, mm, if that is more than the tolerance; else 0.
  double above(const Vec3& from, const Vec3& to) const;
  /// The same for any height.
  double over(const Vec3& from, const Vec3& to) const { return drop_.rise(from, to, 0).above; }

  /// Part and fixtures in the rows' frame.
  const Mesh& mesh() const { return mesh_; }
  std::size_t drops() const { return drops_; }
  void count_drop() const { drops_.fetch_add(1, std::memory_order_relaxed); }
  double tolerance() const { return tolerance_; }

 private:
  std::optional<double> split(const SurfacePoint& a, const SurfacePoint& b, std::vector<SurfacePoint>& out) const;
  bool wanted(const SurfacePoint& p) const;
  /// The slope of the face that it rests on. A level end may rest on the edge of a level face: that is a wall's as
  /// well.
  double rested_slope(const SurfacePoint& p) const;
  bool rolls(const SurfacePoint& p) const;
  bool in_region(const Vec3& p) const;
  Vec3 border(const SurfacePoint& in, const SurfacePoint& out) const;

  Mesh mesh_;
  std::size_t part_triangles_;
  std::vector<Vec3> normals_;
  DropCutter drop_;
  const FinishOptions options_;
  std::vector<std::vector<Vec2>> region_;
  std::vector<char> chosen_;           // of the part's triangles; empty: all
  std::optional<tool::Round> round_;   // the cutter's tip
  double level_end_ = 0;               // radius of the cutter's level end, mm
  double tolerance_, low_, ball_ = 0;  // radius of the ball at the tip, with the allowance; 0: no ball
  mutable std::atomic<std::size_t> drops_ = 0;
};

}  // namespace riffler::plan
