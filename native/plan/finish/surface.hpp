// The offset surface on which finishing rows lie, and the selection of its places. A face of the part is selected if
// the options `slopes`, `region` and `faces` all include it.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "plan/finish/region.hpp"
#include "riffler/plan/drop.hpp"
#include "riffler/plan/finish.hpp"

namespace riffler::plan {

/// One point of the drop surface. Coordinates are those of the rows: x along them, z along the tool's axis.
struct SurfacePoint {
  Vec3 tip{0};  ///< z is meaningless where nothing is touched
  DropCutter::Landing landing;
  bool gap = false;     ///< whether the row does not lead here from the point before
  bool sample = false;  ///< whether the row is straight here, and the selection alone asks for the point
};

/// Computes curves of the drop surface over straight lines.
class FinishSurface {
 public:
  /// `part` and `fixtures` in the rows' frame.
  FinishSurface(const Mesh& part, const std::vector<Mesh>& fixtures, const Tool& tool, const FinishOptions& options,
                const std::vector<std::vector<Vec2>>& region);

  SurfacePoint at(const Vec2& p) const;
  /// Whether the option `region` may select what a cutter touches that reaches this far (mm) from `p`.
  bool may_want(const Vec2& p, double reach) const { return region_.empty() || region_.within(p, reach); }
  /// The points over the line from `from` to `to`. Straight moves between the points are at most `tolerance` below the
  /// drop surface, and where it is continuous at most `tolerance` above it. At a step they rise or sink upright, at
  /// most half the tolerance away from the step.
  std::vector<SurfacePoint> follow(const Vec2& from, const Vec2& to) const;
  /// The same for a line through several points.
  std::vector<SurfacePoint> follow(const std::vector<Vec2>& line) const;
  /// Such a curve with samples at most `step` (mm) apart if the option `region` is given, which may begin or end
  /// anywhere on a straight move.
  std::vector<SurfacePoint> sampled(const std::vector<SurfacePoint>& points, double step) const;
  /// The parts of such a curve where the cutter touches selected faces. Adds places that the tool cannot reach to
  /// `blocked`.
  std::vector<std::vector<Vec3>> meant_pieces(const std::vector<SurfacePoint>& points,
                                              std::vector<BlockedPlace>& blocked) const;
  /// Whether the cutter touches a selected face at a point, and not an edge that it rolls over.
  bool meant(const SurfacePoint& p) const { return wanted(p) && !rolls(p); }
  /// Whether a row may pass a point: the cutter touches a selected face, or an edge.
  bool passes(const SurfacePoint& p) const { return wanted(p) || rolls(p); }
  /// The reason why the tool cannot cut at a point that it touches, or null.
  const char* blocked(const SurfacePoint& p) const;
  /// Whether the options select faces of this slope (rad).
  bool meant_slope(double slope) const;

  /// Whether a face is selected that the cutter touches at `point`. `slope`: of the surface touched, rad.
  bool wanted_face(int triangle, const Vec3& point, double slope) const;
  /// Whether there is a crease between the faces of the part that the cutter touches at two points.
  bool creased(const SurfacePoint& a, const SurfacePoint& b) const;
  /// Unit normal of a triangle of the part, upwards.
  const Vec3& face_normal(int triangle) const { return normals_[static_cast<std::size_t>(triangle)]; }
  /// Slope (rad from level) of a triangle of the part.
  double face_slope(int triangle) const;
  /// Slope (rad) of the tangent plane where a cutter with a round tip touches face or edge; for other cutters the slope
  /// of the face.
  double touched_slope(const SurfacePoint& p) const;
  /// The steepest slope (rad) of the part's faces that `faces` and `slopes` select; negative if there are none.
  double steepest_meant() const;

  /// Largest height (mm) of the drop surface above a straight move, if it is more than the tolerance; else 0.
  double above(const Vec3& from, const Vec3& to) const;
  /// The same without the tolerance.
  double over(const Vec3& from, const Vec3& to) const { return drop_.rise(from, to, 0).above; }

  /// Part and fixtures in the rows' frame.
  const Mesh& mesh() const { return mesh_; }
  /// Number of the mesh's triangles that are the part's: the first ones.
  std::size_t part_triangles() const { return part_triangles_; }
  std::size_t drops() const { return drops_; }
  void count_drop() const { drops_.fetch_add(1, std::memory_order_relaxed); }
  double tolerance() const { return tolerance_; }

 private:
  std::optional<double> split(const SurfacePoint& a, const SurfacePoint& b, std::vector<SurfacePoint>& out) const;
  bool wanted(const SurfacePoint& p) const;
  /// Slope (rad) of the face on which the cutter rests. A cutter with a level end may rest on an edge that a level face
  /// shares with a wall, even if the triangle found is the wall's.
  double rested_slope(const SurfacePoint& p) const;
  bool rolls(const SurfacePoint& p) const;
  Vec3 border(const SurfacePoint& in, const SurfacePoint& out) const;

  Mesh mesh_;
  std::size_t part_triangles_;
  std::vector<Vec3> normals_;
  DropCutter drop_;
  const FinishOptions options_;
  Region region_;
  std::vector<char> chosen_;           // which triangles of the part `faces` selects; empty: all
  std::optional<tool::Round> round_;   // the cutter's tip
  double level_end_ = 0;               // radius of the cutter's level end, mm
  std::optional<double> flank_;        // half angle of a taper, rad
  double tolerance_, low_, ball_ = 0;  // radius of the ball at the tip, with the allowance; 0: no ball
  mutable std::atomic<std::size_t> drops_ = 0;
};

}  // namespace riffler::plan
