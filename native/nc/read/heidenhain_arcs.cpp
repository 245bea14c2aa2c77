// Circles and rounded corners of Heidenhain programs.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "nc/limits.hpp"
#include "nc/read/heidenhain_interpreter.hpp"

namespace riffler::nc {

namespace {

/// mm: a point closer to a line than this gives no arc.
constexpr double kOnLine = 1e-9;

/// Angle from `from` to `to` in the given direction, rad, (0, 2 π].
double turn_between(double from, double to, bool clockwise) {
  const double turn = std::fmod(clockwise ? from - to : to - from, kTwoPi);
  const double positive = turn <= kFullCircle * 1e-3 ? turn + kTwoPi : turn;
  return clockwise ? -positive : positive;
}

}  // namespace

/// CC: two coordinates, which also define the plane of circles about it; without any, the tool's position.
void HeidenhainInterpreter::circle_centre(HeidenhainWords& words) {
  if (words.has_rotary()) place_.fail("CC takes two of X Y Z");
  Pole pole{at_};
  int given = 0;
  for (std::size_t k = 0; k < 3; ++k) given += words.axes[k].given;
  if (given == 0) {
    pole_ = pole;
    return;
  }
  if (given != 2) place_.fail("CC needs two coordinates: write both");
  const std::size_t normal = !words.axes[2].given ? 2 : !words.axes[1].given ? 1 : 0;
  pole.u = (normal + 1) % 3, pole.v = (normal + 2) % 3;
  for (const std::size_t k : {pole.u, pole.v})
    pole.at[static_cast<int>(k)] = words.axes[k].from(at_[static_cast<int>(k)], unit_);
  check_length(pole.at);
  pole_ = pole;
}

const HeidenhainInterpreter::Pole& HeidenhainInterpreter::pole(const char* what) const {
  if (!pole_) place_.fail(std::string(what) + " without a centre: CC before it");
  return *pole_;
}

bool HeidenhainInterpreter::is_clockwise(const HeidenhainWords& words) {
  if (words.clockwise) clockwise_ = words.clockwise;
  if (!clockwise_) place_.fail("an arc without its sense, DR+ or DR-");
  return *clockwise_;
}

void HeidenhainInterpreter::circle(HeidenhainWords& words) {
  begin_codes(words);
  take_feed(words);
  compensate(words.compensation);
  const Pole at = pole("C");
  const bool clockwise = is_clockwise(words);
  const Vec3 from = at_, to = linear_target(words);
  const auto in_plane = [&](const Vec3& p) { return Vec2(p[static_cast<int>(at.u)], p[static_cast<int>(at.v)]); };
  try {
    arc_to(to, arc_about(in_plane(from), in_plane(to), in_plane(at.at), clockwise, arc_miss_), at.u, at.v, words);
  } catch (const std::invalid_argument& e) {
    place_.fail(e.what());
  }
}

/// CR: more than half a turn if R is negative.
void HeidenhainInterpreter::radius_circle(HeidenhainWords& words) {
  begin_codes(words);
  take_feed(words);
  compensate(words.compensation);
  if (!words.arc_radius) place_.fail("CR without R");
  const double radius = *words.arc_radius * unit_;
  if (!(std::abs(radius) <= kMaxLength)) place_.fail("R is out of range");
  const bool clockwise = is_clockwise(words);
  const std::size_t normal = words.axes[2].given && !words.axes[1].given   ? 1
                             : words.axes[2].given && !words.axes[0].given ? 0
                                                                           : 2;
  const std::size_t u = (normal + 1) % 3, v = (normal + 2) % 3;
  const Vec3 from = at_, to = linear_target(words);
  const auto in_plane = [&](const Vec3& p) { return Vec2(p[static_cast<int>(u)], p[static_cast<int>(v)]); };
  try {
    arc_to(to, arc_of_radius(in_plane(from), in_plane(to), radius, clockwise, arc_miss_), u, v, words);
  } catch (const std::invalid_argument& e) {
    place_.fail(e.what());
  }
}

/// The point given by PR, PA and the third coordinate from the pole.
Vec3 HeidenhainInterpreter::polar_target(const HeidenhainWords& words) {
  const Pole& at = pole("a polar coordinate");
  const int u = static_cast<int>(at.u), v = static_cast<int>(at.v);
  if (words.axes[at.u].given || words.axes[at.v].given)
    place_.fail("polar coordinates together with those of their plane");
  const Vec2 from(at_[u] - at.at[u], at_[v] - at.at[v]);
  const double radius = words.radius.from(glm::length(from), unit_);
  const double angle = words.angle.from(base::atan2(from.y, from.x) / kDegree, 1);
  if (!(radius >= 0)) place_.fail("PR is negative");
  if (!(std::abs(angle) <= kMaxAngle)) place_.fail("PA is out of range");
  Vec3 to = linear_target(words);
  to[u] = at.at[u] + radius * base::cos(angle * kDegree), to[v] = at.at[v] + radius * base::sin(angle * kDegree);
  check_length(to);
  return to;
}

/// CP: about the pole by an angle; with the third coordinate, a helix of possibly several turns.
void HeidenhainInterpreter::polar_circle(HeidenhainWords& words) {
  begin_codes(words);
  take_feed(words);
  compensate(words.compensation);
  const Pole at = pole("CP");
  const int u = static_cast<int>(at.u), v = static_cast<int>(at.v);
  if (words.axes[at.u].given || words.axes[at.v].given) place_.fail("CP together with coordinates of its plane");
  if (!words.angle.given) place_.fail("CP without PA or IPA");
  const Vec2 centre(at.at[u], at.at[v]), from = Vec2(at_[u], at_[v]) - centre;
  const double radius = glm::length(from), start = base::atan2(from.y, from.x);
  if (words.radius.given && !(std::abs(words.radius.from(radius, unit_) - radius) <= arc_miss_))
    place_.fail("CP with another radius than that of its start");
  if (!(radius >= kMinRadius)) place_.fail("an arc of radius 0");
  double sweep = words.angle.value * kDegree;
  if (!(std::abs(words.angle.value) <= kMaxAngle)) place_.fail("PA is out of range");
  if (words.angle.incremental) {
    if (sweep == 0) place_.fail("CP by an angle of 0");
    if (words.clockwise && *words.clockwise != (sweep < 0)) place_.fail("IPA and DR have different signs");
    clockwise_ = sweep < 0;
  } else {
    sweep = turn_between(start, sweep, is_clockwise(words));
  }
  Vec3 to = linear_target(words);
  const double end = words.angle.incremental ? start + sweep : words.angle.value * kDegree;
  to[u] = centre.x + radius * base::cos(end), to[v] = centre.y + radius * base::sin(end);
  if (std::abs(sweep) == kTwoPi) to[u] = at_[u], to[v] = at_[v];
  arc_to(to, {centre, radius, radius, start, sweep}, at.u, at.v, words);
}

/// CT: leaves the previous element tangentially.
void HeidenhainInterpreter::tangent_circle(HeidenhainWords& words, bool polar) {
  begin_codes(words);
  take_feed(words);
  compensate(words.compensation);
  const Pole at = polar ? pole("CTP") : Pole{};
  const int u = static_cast<int>(at.u), v = static_cast<int>(at.v);
  const Vec2 along = leaving_ ? Vec2((*leaving_)[u], (*leaving_)[v]) : Vec2(0, 0);
  const Vec2 from(at_[u], at_[v]);
  const Vec3 to = polar ? polar_target(words) : linear_target(words);
  try {
    arc_to(to, tangent_arc(from, Vec2(to[u], to[v]), along, arc_miss_), at.u, at.v, words);
  } catch (const std::invalid_argument& e) {
    place_.fail(e.what());
  }
}

void HeidenhainInterpreter::arc_to(const Vec3& to, const Arc& arc, std::size_t u, std::size_t v,
                                   const HeidenhainWords& words) {
  const NcRowWords row = row_words(words.feed == HeidenhainFeed::Rapid);
  check_no_corner();
  const Joints rotary = rotary_target(words);
  if (rotary != rotary_ && !keeps_tip_) place_.fail("rotary axes turn along an arc without M128");
  stand_[u] = is_away() ? stand_[u] : Stand::Given;
  if (is_away())
    place_.fail("an arc while " + axes_away() + " is at a machine position: move all of X Y Z into the part first");
  if (!keeps_tip_ && !is_upright()) fail_tilted();
  moves_in_part(row);
  arc_rows(to, arc, u, v, rotary, row);
  const double end = arc.start + arc.sweep, sense = arc.sweep < 0 ? -1 : 1;
  leaving_ = Vec3(0);
  (*leaving_)[static_cast<int>(u)] = -sense * base::sin(end), (*leaving_)[static_cast<int>(v)] = sense * base::cos(end);
  end_line(words);
}

void HeidenhainInterpreter::arc_rows(const Vec3& to, const Arc& arc, std::size_t u, std::size_t v, const Joints& rotary,
                                     const NcRowWords& words) {
  if (compensation_->is_leaving()) place_.fail("an arc after R0: write a line before it");
  if (compensates()) {
    if (u != 0) place_.fail("an arc outside the working plane in radius compensation: a line with R0 before it");
    return contour_to(to, &arc, rotary, words);
  }
  check_length(to);
  round_rows(at_, to, arc, {u, v}, {rotary_, rotary}, words);
  at_ = to, rotary_ = rotary;
}

/// From `from` to `to` along `arc` in the axes of `plane`; the rotary axes move evenly.
void HeidenhainInterpreter::round_rows(const Vec3& from, const Vec3& to, const Arc& arc,
                                       std::pair<std::size_t, std::size_t> plane,
                                       const std::pair<Joints, Joints>& rotary, const NcRowWords& words) {
  const auto [u, v] = plane;
  const int chords = arc.chords(rows_->chord_tolerance());
  if (chords > kMaxChords) place_.fail("an arc with too many chords");
  const int x = static_cast<int>(u), y = static_cast<int>(v), w = 3 - x - y;
  rows_->curve(
      in_part(from, rotary.first), chords, geom::hypot(arc.length(), to[w] - from[w]),
      [&](double t) {
        if (t == 1) return in_part(to, rotary.second);
        Joints turning = rotary.first;
        for (std::size_t k = 3; k < turning.size(); ++k) turning[k] += t * (rotary.second[k] - rotary.first[k]);
        const Vec2 p = arc.at(t);
        Vec3 at(0);
        at[x] = p.x, at[y] = p.y, at[w] = from[w] + t * (to[w] - from[w]);
        return in_part(at, turning);
      },
      words);
}

// --- Corners ---

/// Whether the next block is RND or CHF.
bool HeidenhainInterpreter::corner_follows() const {
  for (std::size_t k = next_; k < text_->size(); ++k) {
    const HeidenhainBlock& block = (*text_)[k];
    if (block.optional && block_delete_) continue;
    HeidenhainCursor cursor(block.text, place_);
    const std::string word = cursor.letters();
    return word == "RND" || word == "CHF";
  }
  return false;
}

/// RND, CHF: the size of the corner to which the previous line leads.
void HeidenhainInterpreter::corner(HeidenhainWords& words, bool round) {
  const std::string name = round ? "RND" : "CHF";
  if (!corner_ || corner_->size)
    place_.fail(name + " is read between two lines only: have the CAM system write the corner's moves");
  const std::optional<double> size = words.arc_radius ? words.arc_radius : words.length;
  if (!size || !(*size > 0 && *size * unit_ <= kMaxLength)) place_.fail(name + " needs a positive size");
  if (words.has_linear() || words.has_rotary() || !words.codes.empty()) place_.fail(name + " takes a size and F only");
  corner_->size = *size * unit_, corner_->round = round;
  if (words.feed == HeidenhainFeed::Number) corner_->feed = words.feed_number * feed_unit_;
}

void HeidenhainInterpreter::check_no_corner() const {
  if (corner_) place_.fail("RND or CHF is read between two lines only: have the CAM system write the corner's moves");
}

/// Moves to the corner and around it, towards `to`, and ends at the start of the second line.
void HeidenhainInterpreter::cut_corner(const Vec3& to) {
  if (!corner_->size) check_no_corner();
  const Corner corner = *corner_;
  corner_.reset();
  const Vec3 edge = at_, in = edge - corner.from, out = to - edge;
  if (in.z != 0 || out.z != 0 || !(glm::length(in) > kOnLine && glm::length(out) > kOnLine))
    place_.fail("RND and CHF are read between two lines in the working plane");
  const Vec3 a = glm::normalize(in), b = glm::normalize(out);
  const double turn = base::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b)), half = std::abs(turn) / 2;
  if (!(half < 0.49 * kPi)) place_.fail("RND or CHF where the second line goes back");
  const double leg = corner.round ? *corner.size * base::tan(half) : *corner.size;
  if (!(leg <= glm::length(in) + 1e-6 && leg <= glm::length(out) + 1e-6))
    place_.fail("RND or CHF is larger than its lines");
  at_ = corner.from;
  NcRowWords words = corner.words;
  move_to(edge - leg * a, rotary_, words);
  if (corner.feed > 0) words.feed = corner.feed;
  const Vec3 second = edge + leg * b;
  if (corner.round && half > 1e-9) {
    const double sense = turn < 0 ? -1 : 1;
    const Vec2 from(at_.x, at_.y), centre = from + sense * *corner.size * Vec2(-a.y, a.x);
    arc_rows(second, arc_about(from, Vec2(second.x, second.y), centre, turn < 0, arc_miss_), 0, 1, rotary_, words);
  } else if (leg > 0) {
    move_to(second, rotary_, words);
  }
}

}  // namespace riffler::nc
