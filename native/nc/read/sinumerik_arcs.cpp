// Circles of Sinumerik programs: about a centre, by radius or angle, tangential, and through a point.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "nc/limits.hpp"
#include "nc/read/sinumerik_interpreter.hpp"

namespace riffler::nc {

namespace {

/// mm: points closer to a line than this define no circle.
constexpr double kNoCircle = 1e-6;
constexpr double kMaxTurns = 999;

}  // namespace

/// I J K are relative to the arc's start unless AC is given.
Vec2 SinumerikInterpreter::centre_of(const SinumerikWords& words, const Vec2& from) const {
  const auto [u, v, w] = plane_;
  if (words.centre[w].given && words.centre[w].value != 0 && !words.centre[w].is_absolute(false))
    place_.fail(std::string(1, "IJK"[w]) + " does not lie in the arc's plane");
  const auto of = [&](const SinumerikCoordinate& word, double start) {
    const double value = word.value * unit_;
    if (!(std::abs(value) <= kMaxLength)) place_.fail("the arc's centre is out of range");
    return word.is_absolute(false) ? value : start + value;
  };
  return {of(words.centre[u], from.x), of(words.centre[v], from.y)};
}

/// The arc in its plane; with AR and a centre it also computes the end.
Arc SinumerikInterpreter::plane_arc(const SinumerikWords& words, const Vec2& from, Vec3& to, Motion motion) {
  const int u = static_cast<int>(plane_[0]), v = static_cast<int>(plane_[1]);
  const bool clockwise = motion == Motion::Clockwise, centred = words.has_centre();
  const Vec2 end(to[u], to[v]);
  if (motion == Motion::Tangent) {
    const Vec2 along = leaving_ ? Vec2((*leaving_)[u], (*leaving_)[v]) : Vec2(0, 0);
    return tangent_arc(from, end, along, arc_miss_);
  }
  if (words.radius) {
    if (centred || words.opening) place_.fail("an arc with CR and another word for its circle");
    const double radius = *words.radius * unit_;
    if (!(std::abs(radius) <= kMaxLength)) place_.fail("CR is out of range");
    return arc_of_radius(from, end, radius, clockwise, arc_miss_);
  }
  if (!words.opening) {
    if (!centred) place_.fail("an arc without a centre (I, J, K), CR or AR");
    return arc_about(from, end, centre_of(words, from), clockwise, arc_miss_);
  }
  const double sweep = *words.opening * kDegree;
  if (!(sweep > 0 && sweep < kTwoPi)) place_.fail("AR is an angle between 0 and 360 degrees");
  if (centred && (words.axes[plane_[0]].given || words.axes[plane_[1]].given))
    place_.fail("an arc with AR takes an end or a centre, not both");
  if (centred) {
    const Vec2 centre = centre_of(words, from), arm = from - centre;
    const double start = base::atan2(arm.y, arm.x), radius = glm::length(arm);
    if (!(radius >= kMinRadius)) place_.fail("an arc of radius 0");
    const Arc out{centre, radius, radius, start, clockwise ? -sweep : sweep};
    to[u] = out.at(1).x, to[v] = out.at(1).y;
    return out;
  }
  const double chord = glm::length(end - from);
  if (!(chord >= kFullCircle)) place_.fail("an arc with AR that ends where it begins");
  const double radius = chord / (2 * base::sin(sweep / 2));
  return arc_of_radius(from, end, sweep > kPi ? -radius : radius, clockwise, arc_miss_);
}

void SinumerikInterpreter::arc(const SinumerikWords& words, Motion motion) {
  const NcRowWords row = row_words(false);
  if (words.has_rotary() || words.has_vector())
    place_.fail("an arc in which rotary axes turn is not read: have the CAM system write lines");
  if (is_away())
    place_.fail("an arc while " + axes_away() + " is at a machine position: move all of X Y Z into the part first");
  const Vec2 from(at_[static_cast<int>(plane_[0])], at_[static_cast<int>(plane_[1])]);
  Vec3 to = linear_target(words);
  try {
    Arc made = plane_arc(words, from, to, motion);
    const double turns = words.turns.value_or(0);
    if (!(turns >= 0 && turns <= kMaxTurns && turns == std::floor(turns)))
      place_.fail("TURN takes a whole number of turns, 0 to 999");
    const bool full = std::abs(made.sweep) >= kTwoPi;
    if (full && turns > 0)
      note_once(-14, "helix",
                std::string("TURN counts turns in addition to the block's full circle: TURN=") + number_of(turns) +
                    " makes " + number_of(turns + 1));
    if (turns > 0) made = made.with_turns(1 + static_cast<int>(turns));
    arc_to(to, made, row);
  } catch (const std::invalid_argument& e) {
    place_.fail(e.what());
  }
}

std::string SinumerikInterpreter::number_of(double whole) {
  return std::to_string(static_cast<int>(whole));
}

void SinumerikInterpreter::arc_to(const Vec3& to, const Arc& arc, const NcRowWords& words) {
  check_length(to);
  moves_in_part(words);
  const int chords = arc.chords(rows_->chord_tolerance());
  if (chords > kMaxChords) place_.fail("an arc with too many chords");
  const int u = static_cast<int>(plane_[0]), v = static_cast<int>(plane_[1]), w = static_cast<int>(plane_[2]);
  const Vec3 from = at_;
  rows_->curve(
      in_part(from, rotary_), chords, geom::hypot(arc.length(), to[w] - from[w]),
      [&](double t) {
        Vec3 at = to;
        if (t < 1) {
          const Vec2 p = arc.at(t);
          at[u] = p.x, at[v] = p.y, at[w] = from[w] + t * (to[w] - from[w]);
        }
        return in_part(at, rotary_);
      },
      words);
  at_ = to;
  const double end = arc.start + arc.sweep, sense = arc.sweep < 0 ? -1 : 1;
  leaving_ = Vec3(0);
  (*leaving_)[u] = -sense * base::sin(end), (*leaving_)[v] = sense * base::cos(end);
}

/// CIP: from here through I1 J1 K1 to X Y Z, in any plane.
void SinumerikInterpreter::arc_through(const SinumerikWords& words) {
  const NcRowWords row = row_words(false);
  if (words.has_rotary() || words.has_vector() || words.turns || words.has_centre() || words.radius)
    place_.fail("CIP takes X Y Z and I1= J1= K1=");
  if (is_away()) place_.fail("an arc while " + axes_away() + " is at a machine position");
  const Vec3 from = at_;
  Vec3 via = at_;
  for (std::size_t k = 0; k < 3; ++k)
    if (words.via[k].given)
      via[static_cast<int>(k)] =
          words.via[k].value * unit_ + (words.via[k].is_absolute(absolute_) ? 0 : from[static_cast<int>(k)]);
  check_length(via);
  const Vec3 to = linear_target(words), a = via - from, b = to - from, normal = glm::cross(a, b);
  if (!(glm::length(normal) > kNoCircle * glm::length(b)) || !(glm::length(b) > kNoCircle))
    place_.fail("CIP through a point on the line between its ends: write G1");
  // Centre of the circle through 0, a and b.
  const Vec3 centre = (glm::dot(a, a) * glm::cross(b, normal) + glm::dot(b, b) * glm::cross(normal, a)) /
                      (2 * glm::dot(normal, normal));
  const double radius = glm::length(centre);
  if (!(radius <= kMaxLength)) place_.fail("CIP of a radius that is out of range");
  const Vec3 x = -centre / radius, y = glm::cross(glm::normalize(normal), x), end = b - centre;
  double sweep = base::atan2(glm::dot(end, y), glm::dot(end, x));
  if (sweep <= 0) sweep += kTwoPi;
  const Arc arc{Vec2(0), radius, radius, 0, sweep};
  moves_in_part(row);
  const int chords = arc.chords(rows_->chord_tolerance());
  if (chords > kMaxChords) place_.fail("an arc with too many chords");
  rows_->curve(
      in_part(from, rotary_), chords, arc.length(),
      [&](double t) {
        const Vec2 p = arc.at(t);
        return in_part(t == 1 ? to : from + centre + p.x * x + p.y * y, rotary_);
      },
      row);
  at_ = to;
  leaving_ = base::cos(sweep) * y - base::sin(sweep) * x;
}

}  // namespace riffler::nc
