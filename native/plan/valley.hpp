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
  double least_angle;  ///< rad between the directions to the two sides; less is no valley
  double least_gap;    ///< mm between the ball and the valley's bottom; less is no valley; 0: any gap
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

  /// The result of a start.
  enum class Found { Valley, NoSeat, TooFlat, NoFace };
  /// From a place that the ball cannot reach to a seat: takes the ball of any size that touches there and at a second
  /// place, and grows it to full size.
  Found start(const Unreached& from, Station& station) const;
  /// From a corner, along the edge of its free cone that sides `a` and `b` form; empty if that is no valley.
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

/// The valley of a larger ball with `ball` laid into it: within the plane across, as deep as it goes. Stations where it
/// has no face to rest on are left out.
Valley laid_into(const Valley& valley, const RollingBall& ball);

/// Drops stations on straight lines between others, within `tolerance` / 4 for centres and `tolerance` for contacts
/// (mm).
void simplify(Valley& valley, double tolerance);

}  // namespace riffler::plan
