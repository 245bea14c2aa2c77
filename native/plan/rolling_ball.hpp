// A ball that rolls over a part without entering it.
#pragma once

#include <array>
#include <optional>

#include "mesh/closest.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::plan {

/// A contact of the ball with the part.
struct Foot {
  Vec3 point{0};
  Vec3 away{0};  ///< unit, from the point to the ball's centre
  int triangle = -1;
};

/// The ball in contact with the two sides of a valley.
struct Station {
  Vec3 centre{0};
  std::array<Foot, 2> feet;
  std::array<Vec3, 2> normals{};  ///< of the part at the feet
};

/// The same place with its sides exchanged.
Station exchanged(const Station& station);

/// Each query computes distances afresh and uses no connectivity, so that cracks, doubled walls and crossing walls do
/// not matter. Queries may run on several threads.
class RollingBall {
 public:
  /// Throws std::invalid_argument as Closest. `touch` (mm): triangles this near to a contact share it.
  RollingBall(const Mesh& part, double radius, double touch);

  double radius() const { return radius_; }
  /// Rounding error of a centre's coordinates, mm.
  double rounding() const { return rounding_; }
  const mesh::Closest& part() const { return closest_; }
  /// Unit normal of a triangle; 0 for a triangle without area.
  const Vec3& normal(int triangle) const { return normals_[triangle]; }

  /// What holds the ball where `press` ends: the first two feet in a plane, all three in space.
  struct Seat {
    Vec3 centre;
    std::array<Foot, 3> feet;
  };
  enum class Stop { Seated, Blocked, Lost };
  /// How a ball is pressed into a valley: against `push`, within the plane orthogonal to `across` unless that is 0.
  struct Press {
    Vec3 push, across;
    double radius;  ///< of the ball, mm
    double trust;   ///< the first step's length, mm
    double roam;    ///< largest displacement, mm
  };
  /// Presses the ball from `centre`, where it may enter the part by less than the radius, until the part holds it.
  /// Result Blocked: there is no room; Lost: it moved further than `roam`.
  Stop press(const Vec3& centre, const Press& how, Seat& seat) const;

  /// The part's normal at `foot` if the part faces the ball there. It does on a triangle and on edges and vertices
  /// between triangles that differ by less than kFeatureAngle; it does not where the ball rolls around a sharp or open
  /// edge.
  std::optional<Vec3> faced(const Foot& foot) const;

  /// All feet of a ball at `centre` within `limit` (mm), nearest first; feet in the same direction count once.
  std::vector<Foot> feet(const Vec3& centre, double limit) const;

 private:
  double radius_, touch_, rounding_;
  mesh::Closest closest_;
  std::vector<Vec3> normals_;
};

}  // namespace riffler::plan
