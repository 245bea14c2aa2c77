// A ball that rolls over a part without entering it.
#pragma once

#include <array>
#include <optional>

#include "mesh/closest.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::plan {

/// Where the ball touches the part.
struct Foot {
  Vec3 point{0};
  Vec3 away{0};  ///< unit, from the point to the ball's centre
  int triangle = -1;
};

/// The ball between two sides of a valley.
struct Station {
  Vec3 centre{0};
  std::array<Foot, 2> feet;
  std::array<Vec3, 2> normals{};  ///< of the part at the feet
};

/// The same place with its sides exchanged.
Station exchanged(const Station& station);

/// Distances are found anew at every question and nothing is known of connectivity, so that cracks, doubled and
/// crossing walls do not matter. Questions may be asked on several threads.
class RollingBall {
 public:
  /// std::invalid_argument where Closest throws it. `touch` (mm): triangles that near to a contact share it.
  RollingBall(const Mesh& part, double radius, double touch);

  double radius() const { return radius_; }
  /// Rounding of a centre's coordinates counts as this much, mm.
  double rounding() const { return rounding_; }
  const mesh::Closest& part() const { return closest_; }
  /// Unit normal of a triangle; 0 for one without area.
  const Vec3& normal(int triangle) const { return normals_[triangle]; }

  /// What holds the ball where `press` ends: the first two feet, in a plane, or all three.
  struct Seat {
    Vec3 centre;
    std::array<Foot, 3> feet;
  };
  enum class Stop { Seated, Blocked, Lost };
  /// How a ball is pressed into a valley: against `push`, in the plane square to `across` where that is not 0.
  struct Press {
    Vec3 push, across;
    double radius;  ///< of the ball
    double trust;   ///< the first step's length, mm
    double roam;    ///< how far it may move, mm
  };
  /// Pushes the ball from `centre`, which may enter the part by less than the radius, until the part holds it. Blocked:
  /// there is no room; Lost: it moved farther than it may.
  Stop press(const Vec3& centre, const Press& how, Seat& seat) const;

  /// Whether the part at `foot` faces the ball, and its normal there: it does on a triangle and on the edges and
  /// vertices between triangles that differ by less than kFeatureAngle, but not where the ball rolls around a sharp
  /// edge or an open one.
  std::optional<Vec3> faced(const Foot& foot) const;

  /// All feet of a ball at `centre` within `limit` of it, those that look the same way once, the nearest first.
  std::vector<Foot> feet(const Vec3& centre, double limit) const;

 private:
  double radius_, touch_, rounding_;
  mesh::Closest closest_;
  std::vector<Vec3> normals_;
};

}  // namespace riffler::plan
