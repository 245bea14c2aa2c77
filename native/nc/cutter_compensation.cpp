#include "nc/cutter_compensation.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "geom/math.hpp"
#include "nc/number_text.hpp"

namespace riffler {

namespace {

/// mm: the offsets of elements that meet at a smaller angle are joined without a corner, which misses each by no more.
constexpr double kJoin = 1e-6;
/// mm by which an element may be too short for its inside corners: what rounding of the coordinates does to tangent
/// elements. The tool enters the contour by no more.
constexpr double kShortfall = 0.002;
/// mm: less motion in the plane is none.
constexpr double kStill = 1e-6;
/// rad: elements that go back this exactly lie on each other; which is inside is a matter of their curvature.
constexpr double kReversal = 1e-6;
/// Moves at one point of the contour that may wait.
constexpr std::size_t kMaxStanding = 10'000;

Vec2 left_of(const Vec2& d) {
  return {-d.y, d.x};
}

double cross_of(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}

double angle_of(const Vec2& d) {
  return std::atan2(d.y, d.x);
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
  Vec2 at;            // on the line, or the centre
  Vec2 along{0};      // unit, of the line
  double radius = 0;  // 0: a line
};

/// Where a line and a circle meet: none, or two points, which may be one.
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
  centre_ = std::exchange(leaves_, false) ? beside(at, {centre_[offset.u], centre_[offset.v]}) : at;
}

void CutterCompensation::line(const Joints& to, const NcRowWords& words) {
  const bool moves = glm::length(Vec2(to[offset_.u], to[offset_.v]) - point_) > kStill;
  if (moves) return follow(begun_ ? straight(to, words) : entry_line(to, words));
  if (!waiting_) return go(beside(to, {centre_[offset_.u], centre_[offset_.v]}), std::nullopt, words);
  if (waiting_->standing.size() >= kMaxStanding)
    place_.fail(std::string("too many moves at one point of a contour in cutter compensation: ") + offset_.off +
                " before them");
  waiting_->standing.push_back({to, words});
}

void CutterCompensation::arc(const Joints& to, const Arc& arc, const NcRowWords& words) {
  follow(begun_ ? round(to, arc, words) : entry_arc(to, arc, words));
}

void CutterCompensation::off() {
  if (!on_) return;
  if (waiting_) {
    finish(*waiting_);
    waiting_.reset();
    leaves_ = true;
  }
  on_ = false;
}

// --- Elements ---

Vec2 CutterCompensation::normal(const Vec2& tangent) const {
  return side() * left_of(tangent);
}

CutterCompensation::Element CutterCompensation::straight(const Joints& to, const NcRowWords& words) const {
  Element out;
  out.to = to, out.words = words;
  out.corner = {to[offset_.u], to[offset_.v]};
  out.first = out.last = glm::normalize(out.corner - point_);
  const Vec2 aside = offset_.radius * normal(out.first);
  out.start = point_ + aside, out.end = out.corner + aside;
  return out;
}

CutterCompensation::Element CutterCompensation::round(const Joints& to, const Arc& arc, const NcRowWords& words) const {
  Element out;
  out.to = to, out.words = words;
  out.corner = {to[offset_.u], to[offset_.v]};
  const double sense = sense_of(arc), begin = arc.start, end = arc.start + arc.sweep;
  const Vec2 out_first(std::cos(begin), std::sin(begin)), out_last(std::cos(end), std::sin(end));
  out.first = sense * left_of(out_first), out.last = sense * left_of(out_last);
  out.first_bend = sense / arc.r0, out.last_bend = sense / arc.r1;
  // The tool is on the centre's side of what turns to its own side.
  const double by = -side() * sense * offset_.radius;
  out.arc = arc;
  out.arc->r0 += by, out.arc->r1 += by;
  if (std::min(out.arc->r0, out.arc->r1) < kLeastRadius)
    fail_fit(out,
             "the inside arc of radius " + number_text(std::min(arc.r0, arc.r1)) + " mm is not larger than the tool");
  out.start = arc.centre + out.arc->r0 * out_first, out.end = arc.centre + out.arc->r1 * out_last;
  return out;
}

CutterCompensation::Element CutterCompensation::entry_line(const Joints& to, const NcRowWords& words) const {
  Element out = straight(to, words);
  out.entry = true;
  if (!(glm::length(out.corner - point_) > offset_.radius))
    fail_fit(out, "the first move is not longer than the tool's radius");
  return out;
}

/// The programmed arc leads to the contour from where the centre is. That of the centre ends square to it, and begins
/// where the centre is: its own centre is elsewhere on the same normal.
CutterCompensation::Element CutterCompensation::entry_arc(const Joints& to, const Arc& arc,
                                                          const NcRowWords& words) const {
  if (offset_.entry == CutterEntry::NextElement)
    place_.fail("the first move of a cutter compensation is an arc: begin with a line");
  Element out = round(to, arc, words);
  out.entry = true;
  const Vec2 from(centre_[offset_.u], centre_[offset_.v]), chord = from - out.end;
  const Vec2 inward = glm::normalize(arc.centre - out.corner);
  const double along = glm::dot(chord, inward);
  if (!(glm::length(out.corner - point_) > offset_.radius) || !(along > 1e-3 * glm::length(chord)))
    fail_fit(out, "the first move is an arc that leaves the tool no room");
  const Vec2 centre = out.end + glm::dot(chord, chord) / (2 * along) * inward;
  out.arc = arc_about(from, out.end, centre, arc.sweep < 0, 1);
  out.arc->sweep += sense_of(arc) * kTwoPi * std::floor((std::abs(arc.sweep) - 1e-9) / kTwoPi);
  out.start = from;
  return out;
}

// --- Corners ---

void CutterCompensation::follow(Element next) {
  if (waiting_) {
    join(*waiting_, next);
    finish(*waiting_);
    if (glm::length(next.start - waiting_->end) > kStill) round_corner(*waiting_, next);
  }
  point_ = next.corner;
  begun_ = true;
  waiting_ = std::move(next);
}

/// rad from one element to the next, > 0 towards the tool: an inside corner.
double CutterCompensation::turn(const Element& before, const Element& next) const {
  const double turn = side() * std::atan2(cross_of(before.last, next.first), glm::dot(before.last, next.first));
  if (std::abs(turn) < kPi - kReversal) return turn;
  // The next element goes back: it bends into the tool's side of the one before, or away from it.
  return side() * (before.last_bend + next.first_bend) < -1e-9 ? kPi : -kPi;
}

/// Where `before` ends and `next` begins. Unless the two are one point an arc about the corner lies between them.
void CutterCompensation::join(Element& before, Element& next) {
  if (before.entry && offset_.entry == CutterEntry::NextElement) {
    before.end = next.start;
    return;
  }
  const double angle = turn(before, next);
  if (std::abs(angle) < 0.1 && offset_.radius * angle * angle / 8 <= kJoin) {
    const Vec2 between = glm::normalize(normal(before.last) + normal(next.first));
    const Vec2 at = before.corner + offset_.radius * between;
    end_at(before, at, false), begin_at(next, at, false);
  } else if (angle > 0) {
    const std::optional<Vec2> at = meeting(before, next);
    if (!at) fail_fit(next, "the tool does not fit into the inside corner before this move");
    end_at(before, *at, true), begin_at(next, *at, true);
  }
}

/// Of the points where the offsets of two elements meet, the first that is met going back from the end of `before`:
/// from there on it lies within the tool's radius of `next`.
std::optional<Vec2> CutterCompensation::meeting(const Element& before, const Element& next) const {
  const Curve a = before.arc ? Curve{before.arc->centre, Vec2(0), glm::length(before.end - before.arc->centre)}
                             : Curve{before.end, before.last};
  const Curve b = next.arc ? Curve{next.arc->centre, Vec2(0), glm::length(next.start - next.arc->centre)}
                           : Curve{next.start, next.first};
  std::optional<Vec2> found;
  double nearest = 0;
  for (const Vec2& at : meetings(a, b)) {
    double back = glm::dot(before.end - at, before.last);
    if (before.arc) {
      const double angle = sense_of(*before.arc) * (angle_of(before.end - a.at) - angle_of(at - a.at));
      back = a.radius * wrapped(angle, -kJoin / a.radius);
    }
    if (back >= -kJoin && (!found || back < nearest)) found = at, nearest = back;
  }
  return found;
}

/// `beyond`: an arc is shortened by up to a whole turn; otherwise by next to nothing, or lengthened.
void CutterCompensation::begin_at(Element& element, const Vec2& at, bool beyond) const {
  if (const auto& arc = element.arc) {
    const double angle = sense_of(*arc) * (angle_of(at - arc->centre) - angle_of(element.start - arc->centre));
    element.late = wrapped(angle, beyond ? -kJoin / arc->r0 : -kPi);
  }
  element.start = at;
}

void CutterCompensation::end_at(Element& element, const Vec2& at, bool beyond) const {
  if (const auto& arc = element.arc) {
    const double angle = sense_of(*arc) * (angle_of(element.end - arc->centre) - angle_of(at - arc->centre));
    element.early = wrapped(angle, beyond ? -kJoin / arc->r1 : -kPi);
  }
  element.end = at;
}

/// About the end of `before`. A rapid is straight, as on LinuxCNC.
void CutterCompensation::round_corner(const Element& before, const Element& next) {
  const Vec2 from = before.end - before.corner, to = next.start - before.corner;
  const Joints end = beside(centre_, next.start);
  if (next.words.rapid) return go(end, std::nullopt, next.words);
  const double sweep = side() * turn(before, next);
  go(end, Arc{before.corner, glm::length(from), glm::length(to), angle_of(from), sweep}, next.words);
}

// --- Moves of the centre ---

Joints CutterCompensation::beside(const Joints& joints, const Vec2& centre) const {
  Joints out = joints;
  out[offset_.u] = centre.x, out[offset_.v] = centre.y;
  return out;
}

void CutterCompensation::finish(const Element& element) {
  const Joints to = beside(element.to, element.end);
  if (!element.arc) {
    if (!element.entry && glm::dot(element.end - element.start, element.last) < -kShortfall)
      fail_fit(element, "the line is too short for the tool between its neighbours");
    go(to, std::nullopt, element.words);
  } else {
    const Arc& arc = *element.arc;
    const Vec2 from = element.start - arc.centre, end = element.end - arc.centre;
    const double sweep = std::abs(arc.sweep) - element.late - element.early, radius = std::min(arc.r0, arc.r1);
    if (sweep * radius < -kShortfall) fail_fit(element, "the arc is too short for the tool between its neighbours");
    if (sweep * radius <= kStill)
      go(to, std::nullopt, element.words);
    else
      go(to, Arc{arc.centre, glm::length(from), glm::length(end), angle_of(from), sense_of(arc) * sweep},
         element.words);
  }
  for (const Standing& move : element.standing) go(beside(move.to, element.end), std::nullopt, move.words);
}

void CutterCompensation::go(const Joints& to, const std::optional<Arc>& arc, const NcRowWords& words) {
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

}  // namespace riffler
