#include "nc/read/cutter_compensation.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "nc/limits.hpp"
#include "nc/number_text.hpp"

namespace riffler::nc {

namespace {

/// mm: two nearly tangent elements are joined at one point, without a corner, if it is this close to both offsets.
constexpr double kJoin = 1e-6;
/// mm by which an element may be too short for its inside corners, because of rounded coordinates. The tool enters the
/// contour by at most this.
constexpr double kShortfall = 0.002;
/// Shortest chord of the centre's entry arc, mm.
constexpr double kMinEntryChord = 0.01;
/// mm: a shorter motion in the plane counts as none.
constexpr double kStill = 1e-6;
/// rad from a reversal: within it, the curvatures decide on which side the corner is.
constexpr double kReversal = 1e-6;
/// Bounds the memory for moves at one point of the contour.
constexpr std::size_t kMaxStationary = 10'000;

Vec2 left_of(const Vec2& d) {
  return {-d.y, d.x};
}

double cross_of(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}

double angle_of(const Vec2& d) {
  return base::atan2(d.y, d.x);
}

/// `angle` in [`low`, `low` + 2 π).
double wrapped(double angle, double low) {
  return angle - kTwoPi * std::floor((angle - low) / kTwoPi);
}

double sense_of(const Arc& arc) {
  return arc.sweep < 0 ? -1 : 1;
}

/// A line or a circle.
struct Curve {
  Vec2 at;            // a point of the line, or the centre
  Vec2 along{0};      // unit direction of the line
  double radius = 0;  // 0: a line
};

/// Intersections of a line and a circle: none, or two, which may coincide.
std::vector<Vec2> meetings(const Curve& line, const Vec2& centre, double radius) {
  const Vec2 foot = line.at + glm::dot(centre - line.at, line.along) * line.along;
  const double height = glm::length(centre - foot);
  if (height > radius + kJoin) return {};
  const double half = std::sqrt(std::max(0.0, (radius - height) * (radius + height)));
  return {foot - half * line.along, foot + half * line.along};
}

std::vector<Vec2> meetings(const Curve& a, const Curve& b) {
  if (a.radius == 0 && b.radius == 0) {
    const double sine = cross_of(a.along, b.along);
    if (sine == 0) return {};
    return {a.at + cross_of(b.at - a.at, b.along) / sine * a.along};
  }
  if (a.radius == 0) return meetings(a, b.at, b.radius);
  if (b.radius == 0) return meetings(b, a.at, a.radius);
  const Vec2 between = b.at - a.at;
  const double distance = glm::length(between);
  if (!(distance > 0)) return {};
  const Vec2 towards = between / distance;
  const double along = (distance + (a.radius - b.radius) / distance * (a.radius + b.radius)) / 2;
  if (std::abs(along) > a.radius + kJoin) return {};
  const double half = std::sqrt(std::max(0.0, (a.radius - along) * (a.radius + along)));
  const Vec2 foot = a.at + along * towards;
  return {foot - half * left_of(towards), foot + half * left_of(towards)};
}

}  // namespace

void CutterCompensation::on(const CutterOffset& offset, const Joints& at) {
  offset_ = offset;
  on_ = true, begun_ = false;
  point_ = {at[offset.u], at[offset.v]};
  centre_ = std::exchange(leaving_, false) ? with_centre(at, {centre_[offset.u], centre_[offset.v]}) : at;
}

void CutterCompensation::line(const Joints& to, const NcRowWords& words) {
  const bool moves = glm::length(Vec2(to[offset_.u], to[offset_.v]) - point_) > kStill;
  if (moves) return append(begun_ ? line_element(to, words) : entry_line(to, words));
  if (!pending_) return go(with_centre(to, {centre_[offset_.u], centre_[offset_.v]}), std::nullopt, words);
  if (pending_->stationary.size() >= kMaxStationary)
    place_.fail(std::string("too many moves at one point of a contour in cutter compensation: ") + offset_.off +
                " before them");
  pending_->stationary.push_back({to, words});
}

void CutterCompensation::arc(const Joints& to, const Arc& arc, const NcRowWords& words) {
  append(begun_ ? arc_element(to, arc, words) : entry_arc(to, arc, words));
}

void CutterCompensation::off() {
  if (!on_) return;
  if (pending_) {
    finish(*pending_);
    pending_.reset();
    leaving_ = true;
  }
  on_ = false;
}

// --- Elements ---

Vec2 CutterCompensation::normal(const Vec2& tangent) const {
  return side() * left_of(tangent);
}

CutterCompensation::Element CutterCompensation::line_element(const Joints& to, const NcRowWords& words) const {
  Element out;
  out.to = to, out.words = words;
  out.corner = {to[offset_.u], to[offset_.v]};
  out.start_tangent = out.end_tangent = glm::normalize(out.corner - point_);
  const Vec2 aside = offset_.radius * normal(out.start_tangent);
  out.start = point_ + aside, out.end = out.corner + aside;
  return out;
}

CutterCompensation::Element CutterCompensation::arc_element(const Joints& to, const Arc& arc,
                                                            const NcRowWords& words) const {
  Element out;
  out.to = to, out.words = words;
  out.corner = {to[offset_.u], to[offset_.v]};
  const double sense = sense_of(arc), begin = arc.start, end = arc.start + arc.sweep;
  const Vec2 out_first(base::cos(begin), base::sin(begin)), out_last(base::cos(end), base::sin(end));
  out.start_tangent = sense * left_of(out_first), out.end_tangent = sense * left_of(out_last);
  out.start_curvature = sense / arc.r0, out.end_curvature = sense / arc.r1;
  // An arc that curves towards the tool has the tool inside.
  const double by = -side() * sense * offset_.radius;
  out.arc = arc;
  out.arc->r0 += by, out.arc->r1 += by;
  if (std::min(out.arc->r0, out.arc->r1) < kMinRadius)
    fail_fit(out,
             "the inside arc of radius " + number_text(std::min(arc.r0, arc.r1)) + " mm is not larger than the tool");
  out.start = arc.centre + out.arc->r0 * out_first, out.end = arc.centre + out.arc->r1 * out_last;
  return out;
}

CutterCompensation::Element CutterCompensation::entry_line(const Joints& to, const NcRowWords& words) const {
  Element out = line_element(to, words);
  out.entry = true;
  if (!(glm::length(out.corner - point_) > offset_.radius))
    fail_fit(out, "the first move is not longer than the tool's radius");
  return out;
}

/// The programmed arc starts at the tool's centre and ends on the contour. The centre's arc starts there too, but ends
/// next to the contour: its own centre lies elsewhere on the same normal.
CutterCompensation::Element CutterCompensation::entry_arc(const Joints& to, const Arc& arc,
                                                          const NcRowWords& words) const {
  if (offset_.entry == CutterEntry::NextElement)
    place_.fail("the first move of a cutter compensation is an arc: begin with a line");
  Element out = arc_element(to, arc, words);
  out.entry = true;
  const Vec2 from(centre_[offset_.u], centre_[offset_.v]), chord = from - out.end;
  const Vec2 inward = glm::normalize(arc.centre - out.corner);
  const double along = glm::dot(chord, inward);
  const bool reaches = glm::length(out.corner - point_) > offset_.radius && glm::length(chord) > kMinEntryChord;
  if (!reaches || !(along > 1e-3 * glm::length(chord)))
    fail_fit(out, "the first move is an arc that leaves the tool no room");
  const Vec2 centre = out.end + glm::dot(chord, chord) / (2 * along) * inward;
  out.arc = arc_about(from, out.end, centre, arc.sweep < 0, 1);
  out.arc->sweep += sense_of(arc) * kTwoPi * std::floor((std::abs(arc.sweep) - 1e-9) / kTwoPi);
  out.start = from;
  return out;
}

// --- Corners ---

void CutterCompensation::append(Element next) {
  if (pending_) {
    join(*pending_, next);
    finish(*pending_);
    if (glm::length(next.start - pending_->end) > kStill) round_corner(*pending_, next);
  }
  point_ = next.corner;
  begun_ = true;
  pending_ = std::move(next);
}

/// Rotation from one element to the next, rad; > 0 towards the tool: an inside corner.
double CutterCompensation::turn(const Element& before, const Element& next) const {
  const double turn = side() * base::atan2(cross_of(before.end_tangent, next.start_tangent),
                                           glm::dot(before.end_tangent, next.start_tangent));
  if (std::abs(turn) < kPi - kReversal) return turn;
  // The next element reverses: it curves to the tool's side of the one before, or away from it.
  return side() * (before.end_curvature + next.start_curvature) < -1e-9 ? kPi : -kPi;
}

/// Sets the end of `before` and the start of `next`. If they differ, an arc about the corner joins them.
void CutterCompensation::join(Element& before, Element& next) {
  if (before.entry && offset_.entry == CutterEntry::NextElement) {
    before.end = next.start;
    return;
  }
  const double angle = turn(before, next);
  if (std::abs(angle) < 0.1 && offset_.radius * angle * angle / 8 <= kJoin) {
    const Vec2 between = glm::normalize(normal(before.end_tangent) + normal(next.start_tangent));
    const Vec2 at = before.corner + offset_.radius * between;
    end_at(before, at, false), begin_at(next, at, false);
  } else if (angle > 0) {
    const std::optional<Vec2> at = meeting(before, next);
    if (!at) fail_fit(next, "the tool does not fit into the inside corner before this move");
    end_at(before, *at, true), begin_at(next, *at, true);
  }
}

/// The first point, going back from the end of `before`, where the offsets of both elements meet. From there to its
/// end, `before` is closer to `next` than the tool's radius.
std::optional<Vec2> CutterCompensation::meeting(const Element& before, const Element& next) const {
  const Curve a = before.arc ? Curve{before.arc->centre, Vec2(0), glm::length(before.end - before.arc->centre)}
                             : Curve{before.end, before.end_tangent};
  const Curve b = next.arc ? Curve{next.arc->centre, Vec2(0), glm::length(next.start - next.arc->centre)}
                           : Curve{next.start, next.start_tangent};
  std::optional<Vec2> found;
  double nearest = 0;
  for (const Vec2& at : meetings(a, b)) {
    double back = glm::dot(before.end - at, before.end_tangent);
    if (before.arc) {
      const double angle = sense_of(*before.arc) * (angle_of(before.end - a.at) - angle_of(at - a.at));
      back = a.radius * wrapped(angle, -kJoin / a.radius);
    }
    if (back >= -kJoin && (!found || back < nearest)) found = at, nearest = back;
  }
  return found;
}

/// Moves the start to `at`. `beyond`: along an arc by up to a whole turn; otherwise it stays near, on either side.
void CutterCompensation::begin_at(Element& element, const Vec2& at, bool beyond) const {
  if (const auto& arc = element.arc) {
    const double angle = sense_of(*arc) * (angle_of(at - arc->centre) - angle_of(element.start - arc->centre));
    element.trim_start = wrapped(angle, beyond ? -kJoin / arc->r0 : -kPi);
  }
  element.start = at;
}

void CutterCompensation::end_at(Element& element, const Vec2& at, bool beyond) const {
  if (const auto& arc = element.arc) {
    const double angle = sense_of(*arc) * (angle_of(element.end - arc->centre) - angle_of(at - arc->centre));
    element.trim_end = wrapped(angle, beyond ? -kJoin / arc->r1 : -kPi);
  }
  element.end = at;
}

/// An arc about the end of `before`. Rapids go straight, as in LinuxCNC.
void CutterCompensation::round_corner(const Element& before, const Element& next) {
  const Vec2 from = before.end - before.corner, to = next.start - before.corner;
  const Joints end = with_centre(centre_, next.start);
  if (next.words.rapid) return go(end, std::nullopt, next.words);
  const double sweep = side() * turn(before, next);
  go(end, Arc{before.corner, glm::length(from), glm::length(to), angle_of(from), sweep}, next.words);
}

// --- Moves of the centre ---

Joints CutterCompensation::with_centre(const Joints& joints, const Vec2& centre) const {
  Joints out = joints;
  out[offset_.u] = centre.x, out[offset_.v] = centre.y;
  return out;
}

void CutterCompensation::finish(const Element& element) {
  const Joints to = with_centre(element.to, element.end);
  if (!element.arc) {
    if (!element.entry && glm::dot(element.end - element.start, element.end_tangent) < -kShortfall)
      fail_fit(element, "the line is too short for the tool between its neighbours");
    go(to, std::nullopt, element.words);
  } else {
    const Arc& arc = *element.arc;
    const Vec2 from = element.start - arc.centre, end = element.end - arc.centre;
    const double sweep = std::abs(arc.sweep) - element.trim_start - element.trim_end, radius = std::min(arc.r0, arc.r1);
    if (sweep * radius < -kShortfall) fail_fit(element, "the arc is too short for the tool between its neighbours");
    if (sweep * radius <= kStill)
      go(to, std::nullopt, element.words);
    else
      go(to, Arc{arc.centre, glm::length(from), glm::length(end), angle_of(from), sense_of(arc) * sweep},
         element.words);
  }
  for (const StationaryMove& move : element.stationary) go(with_centre(move.to, element.end), std::nullopt, move.words);
}

void CutterCompensation::go(const Joints& to, const std::optional<Arc>& arc, const NcRowWords& words) {
  for (const std::size_t k : {offset_.u, offset_.v})
    if (!(std::abs(to[k]) <= kMaxLength)) place_.fail("cutter compensation leads out of range");
  emit_({centre_, to, arc, words});
  centre_ = to;
}

void CutterCompensation::fail_fit(const Element& element, const std::string& what) const {
  const std::string where =
      element.words.line == place_.line ? "" : "line " + std::to_string(element.words.line) + ": ";
  place_.fail("cutter compensation by " + number_text(offset_.radius) + " mm: " + where + what +
              ": give a smaller diameter, or, where the points are those of the tool's centre, read the program with "
              "options {'cutter_compensation': 'ignore'}");
}

}  // namespace riffler::nc
