// One valley: the curve along which the ball touches two sides, traced from a place on it.
#pragma once

#include <optional>
#include <vector>

#include "plan/contact_net.hpp"
#include "plan/rolling_ball.hpp"

namespace riffler::plan {

/// The criteria of a valley.
struct ValleyRules {
  double tolerance;    ///< mm, of the polyline
  double jump;         ///< rad: sides that differ by less are facets of one side
  double least_angle;  ///< rad, smallest angle of a valley between the directions to its two sides
  double least_gap;    ///< mm, smallest gap of a valley between the ball and its bottom; 0: any gap
};

/// Why a valley ends.
enum class ValleyEnd : unsigned char {
  Loop,
  Corner,   ///< a third side holds the ball
  Part,     ///< a contact leaves over a sharp or open edge
  TooFlat,  ///< the angle between the sides becomes too small
  Cut,      ///< too many stations: a defect of the part
  Joined,   ///< another path continues here
};

struct Valley {
  std::vector<Station> stations;
  std::array<ValleyEnd, 2> ends{ValleyEnd::Cut, ValleyEnd::Cut};
  bool closed() const { return ends[0] == ValleyEnd::Loop; }
};

class ValleyTracer {
 public:
  ValleyTracer(const RollingBall& ball, const ValleyRules& rules) : ball_(ball), rules_(rules) {}

  /// Result of start().
  enum class Found { Valley, NoSeat, TooFlat, NoFace };
  /// Finds a seat of the ball from a place that the ball cannot reach: takes a smaller ball that touches there and at a
  /// second place, and grows it to full size.
  Found start(const Unreached& from, Station& station) const;
  /// The first station from a corner along the edge of its free cone that sides `a` and `b` form; empty if that edge is
  /// no valley.
  std::optional<Station> leave(const Vec3& corner, const Foot& a, const Foot& b, const Vec3& way) const;

  /// Traces in both directions from `seed`. `steps` counts the balls placed.
  Valley trace(const Station& seed, std::size_t& steps) const;

  /// The valleys that leave a corner: all pairs of its feet along which the ball can move away.
  std::vector<Station> branches(const Vec3& corner) const;

 private:
  enum class Event { None, Jump, NoFace, TooFlat };

  bool is_deep(const Station& station) const;
  Event accept(const RollingBall::Seat& seat, const Station* like, Station& station) const;
  Event advance(const Station& from, double sign, double length, Station& to) const;
  std::optional<Station> corner_near(const Station& last, double sign, double within) const;
  bool is_home(const Station& seed, double sign, const Station& last, const Station& next, bool& has_left) const;
  double bend_of_first(const Station& from, double sign, double step, const Station& to) const;
  ValleyEnd follow(const Station& seed, double sign, std::vector<Station>& out, std::size_t& steps) const;

  const RollingBall& ball_;
  ValleyRules rules_;
};

/// Lays `ball` into the valley of a larger ball: at each station as deep as it goes in the plane across the valley.
/// Leaves out stations where the ball has no face to rest on.
Valley laid_into(const Valley& valley, const RollingBall& ball);

/// Drops stations that lie on straight lines between others, to within `tolerance` / 4 (mm) for centres and `tolerance`
/// for contacts.
void simplify(Valley& valley, double tolerance);

}  // namespace riffler::plan
