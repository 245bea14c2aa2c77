// Blocks that move: lines, arcs, splines, canned cycles.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "nc/limits.hpp"
#include "nc/read/drill_cycle.hpp"
#include "nc/read/interpreter.hpp"

namespace riffler::nc {

namespace {

constexpr std::array<char, 3> kAxes{'X', 'Y', 'Z'}, kCentre{'I', 'J', 'K'};

}  // namespace

/// Whether a code other than the motion's uses the axis words.
bool NcInterpreter::axes_are_taken() const {
  switch (words_->code(NcGroup::NonModal)) {
    case 40:  // dwell: X is its time
      return !words_->has('P');
    case 100:
    case 280:
    case 300:
    case 520:
    case 920:
      return true;
    default:
      return words_->code(NcGroup::ToolLength) == 431;
  }
}

void NcInterpreter::motion() {
  const int code = words_->code(NcGroup::Motion);
  const bool by_machine = words_->code(NcGroup::NonModal) == 530;
  if (code >= 0) {
    if (axes_are_taken() && code != 800 && words_->has_axes() && !(code <= 10 && goes_home()))
      place_.fail("two codes that both use axis words: they need a block each");
    choose_motion(code);
    chosen_ = chosen_ || code != 800;
  }
  if (code >= 0 || by_machine) refuse(code == 800 ? -1 : motion_);
  if (axes_are_taken()) return;
  const bool arc = motion_ == 20 || motion_ == 30;
  if (!words_->has_axes() && !(arc && (words_->has('I') || words_->has('J') || words_->has('K')))) {
    if (code == 20 || code == 30) place_.fail("an arc without an end or a centre");
    if (code == 10) check_feed();
    if (is_drill_cycle(code)) place_.fail("a canned cycle without axis words");
    return;
  }
  if (motion_ < 0 || code == 800) motion_at_start(code);
  if (cancelled_ && !by_machine)
    note("motion", "axis words after G80: taken as the motion from before the cycle, as Fanuc's controls do");
  cancelled_ = false;
  if (by_machine) {
    if (motion_ > 10) place_.fail("G53 goes with G0 and G1 only");
    if (!modes_.absolute) place_.fail("G53 under G91: machine positions are absolute (G90)");
  }
  move(motion_);
}

/// G80 ends a cycle and restores the motion before it, as on Fanuc controls; LinuxCNC requires it to be named.
void NcInterpreter::choose_motion(int code) {
  cycle_.code = is_drill_cycle(code) ? cycle_.code : -1;
  cancelled_ = code == 800;
  if (cancelled_) {
    if (is_drill_cycle(motion_)) motion_ = before_cycle_;
    return;
  }
  if (is_drill_cycle(code) && !is_drill_cycle(motion_)) before_cycle_ = motion_;
  motion_ = code;
}

/// G0 and G1 in the same block set the motion mode afterwards.
bool NcInterpreter::goes_home() const {
  const int code = words_->code(NcGroup::NonModal);
  return code == 280 || code == 300;
}

void NcInterpreter::move(int code) {
  if (!is_drill_cycle(code)) cycle_.code = -1;
  if (code != 50) spline_end_.reset();
  if (code != 0) check_feed();
  const bool by_machine = words_->code(NcGroup::NonModal) == 530;
  if (is_drill_cycle(code)) return drill_at(code);
  if (code > 10) check_stands_in_part("an arc or a spline"), check_not_leaving();
  if (code <= 30 && !by_machine && compensates()) return contour_to(target(), code);
  const Joints to = by_machine ? machine_target() : target();
  if (code <= 10)
    line_to(to, code == 0);
  else if (code <= 30)
    arc_to(to, code == 20);
  else
    spline_to(to, code);
}

/// Rejects what cannot be expressed as tool poses and what is not supported.
void NcInterpreter::refuse(int code) {
  switch (code) {
    case 382:
    case 383:
    case 384:
    case 385:
      place_.fail("probing (G38) cannot be simulated: only the machine knows where it ends");
    case 330:
    case 331:
    case 760:
      place_.fail("threads (G33, G33.1, G76) are cut by the spindle's position: they are not read");
    case 870:
    case 880:
      place_.fail("canned cycles that stop for the operator (G87, G88) are not read");
    case 52:
    case 53:
      place_.fail("NURBS (G5.2, G5.3) are not read: have the CAM system write arcs or lines");
    default:
      return;
  }
}

/// The motion that the control has when it is switched on, where the program has not named one.
void NcInterpreter::motion_at_start(int code) {
  if (code == 800 || chosen_) place_.fail("axis words without a motion (G0, G1, G2, G3)");
  if (given_.motion < 0)
    place_.fail(
        "axis words without a motion (G0, G1, G2, G3): option first_motion names the one at the control's start");
  choose_motion(given_.motion);
  note("motion", "axis words before the first motion: taken as " + given_.motion_name + ", by option first_motion");
}

void NcInterpreter::check_feed() {
  if (!(modes_.feed > 0) && given_.feed && modes_.feed_mode == 940 && !feed_given_) {
    modes_.feed = *given_.feed;
    if (!std::exchange(feed_noted_, true))
      note("feed", "a feed move before the first F: taken at the feed of option first_feed");
  }
  if (modes_.feed > 0) {
    if (modes_.feed_mode != 950) return;
    if (modes_.surface_speed) place_.fail("a feed per revolution (G95) under G96: the spindle's speed is not known");
    if (!(modes_.speed > 0)) place_.fail("a feed per revolution (G95) without a spindle speed S");
    if (!(modes_.feed * modes_.speed <= kMaxFeed)) place_.fail("F is out of range");
    return;
  }
  if (modes_.feed_mode == 930) place_.fail("a feed move without F: under G93 every block needs its own");
  place_.fail(modes_.feed_mode == 950 || feed_given_
                  ? "a feed move without F"
                  : "a feed move without F: option first_feed, mm/min, holds until the first F");
}

Joints NcInterpreter::target() {
  Joints to = at_;
  for (const char letter : rows_->machine().axes()) {
    if (!words_->has(letter)) continue;
    const std::size_t k = joint_index(letter);
    const double word = length_or_angle(k);
    to[k] = modes_.absolute ? word : at_[k] + word;
    if (modes_.absolute) stand_[k] = Stand::Given;
    if (!(std::abs(to[k]) <= (k < 3 ? kMaxLength : kMaxAngle)))
      place_.fail(std::string(1, letter) + " is out of range");
  }
  return to;
}

NcRowWords NcInterpreter::row_words(bool rapid) {
  if (length_off_) {
    note("tool length", "a move after G49: its points are taken as those of the tip");
    length_off_ = false;
  }
  return {rapid,
          modes_.feed_mode == 950 ? modes_.feed * modes_.speed : modes_.feed,
          modes_.feed_mode == 930,
          modes_.turning * modes_.speed,
          tool_,
          flow_->program_line()};
}

void NcInterpreter::line_to(const Joints& to, bool rapid) {
  const NcRowWords words = row_words(rapid);
  if (rapid && !rapid_noted_) note_rapid(to);
  straight_to(to, words);
}

/// Adds a row in the part, or at a machine position.
void NcInterpreter::straight_to(const Joints& to, const NcRowWords& words) {
  const bool in_part = moves_in_part(words.rapid);
  leave_contour(to, in_part);
  if (in_part)
    rows_->line(at_, to, words);
  else
    rows_->at_machine(words);
  at_ = to;
}

Arc NcInterpreter::arc_of_words(const Joints& to, bool clockwise) {
  const auto [u, v, w] = modes_.plane;
  Arc arc{};
  try {
    arc = the_arc({at_[u], at_[v]}, {to[u], to[v]}, clockwise);
  } catch (const std::invalid_argument& e) {
    place_.fail(e.what());
  }
  if (words_->has('P')) {
    const int turns = words_->whole('P');
    if (turns < 1) place_.fail("P of an arc is its number of turns: at least 1");
    arc = arc.with_turns(turns);
  }
  return arc;
}

void NcInterpreter::arc_to(const Joints& to, bool clockwise) {
  const auto [u, v, w] = modes_.plane;
  const Arc arc = arc_of_words(to, clockwise);
  moves_in_part(false);
  rows_->arc(at_, to, arc, u, v, row_words(false));
  at_ = to;
}

Arc NcInterpreter::the_arc(const Vec2& from, const Vec2& end, bool clockwise) {
  const auto [u, v, w] = modes_.plane;
  if (words_->has(kCentre[w]) && words_->value(kCentre[w], kMaxLength) != 0)
    place_.fail(std::string(1, kCentre[w]) + " does not lie in the arc's plane");
  const bool offsets = words_->has(kCentre[u]) || words_->has(kCentre[v]);
  if (words_->has('R')) {
    if (offsets) place_.fail("an arc with both R and a centre");
    return arc_of_radius(from, end, words_->value('R', kMaxLength) * modes_.unit, clockwise,
                         std::max(kRadiusMiss, given_.arc_miss == kArcMiss ? 0 : given_.arc_miss));
  }
  if (!offsets) place_.fail("an arc without a centre (I, J, K) or R");
  const bool both = words_->has(kCentre[u]) && words_->has(kCentre[v]);
  if (modes_.absolute_centre && !both)
    place_.fail(std::string("with absolute centres (G90.1) an arc needs both ") + kCentre[u] + " and " + kCentre[v]);
  const auto offset = [&](std::size_t axis) {
    return words_->has(kCentre[axis]) ? words_->value(kCentre[axis], kMaxLength) * modes_.unit : 0;
  };
  const Vec2 words(offset(u), offset(v)), centre = modes_.absolute_centre ? words : from + words;
  if (both) check_centre(from, end, centre, modes_.absolute_centre ? from + words : words);
  return arc_about(from, end, centre, clockwise, given_.arc_miss);
}

/// Fails if the arc's end misses its circle, and would not if I, J and K had the other meaning: controls differ in the
/// one they begin with.
void NcInterpreter::check_centre(const Vec2& from, const Vec2& end, const Vec2& centre, const Vec2& other) {
  const auto miss = [&](const Vec2& c) { return std::abs(glm::length(end - c) - glm::length(from - c)); };
  if (miss(centre) <= given_.arc_miss || miss(other) > given_.arc_miss) return;
  char text[64];
  std::snprintf(text, sizeof text, "the arc's end misses its circle by %.4f mm", miss(centre));
  place_.fail(std::string(text) +
              (modes_.absolute_centre ? ", and fits it with a centre relative to its start (G91.1)"
                                      : ", and fits it with an absolute centre (G90.1)") +
              ": option arc_centres");
}

/// G5: a cubic with control points I J from its start and P Q from its end; G5.1: a quadratic, I J from its start.
void NcInterpreter::spline_to(const Joints& to, int code) {
  refuse_in_compensation("a spline (G5, G5.1)");
  if (modes_.plane[2] != 2) place_.fail("splines (G5, G5.1) lie in the plane of G17");
  for (std::size_t k = 2; k < 6; ++k)
    if (to[k] != at_[k]) place_.fail("splines (G5, G5.1) move X and Y only");
  const auto vector = [&](char x, char y) {
    return modes_.unit *
           Vec2(words_->has(x) ? words_->value(x, kMaxLength) : 0, words_->has(y) ? words_->value(y, kMaxLength) : 0);
  };
  const Vec2 a(at_[0], at_[1]), d(to[0], to[1]);
  Vec2 b, c;
  if (code == 50) {
    if (!(words_->has('P') && words_->has('Q'))) place_.fail("G5 needs P and Q");
    if (words_->has('I') != words_->has('J') || !(words_->has('I') || spline_end_)) place_.fail("G5 needs I and J");
    b = a + (words_->has('I') ? vector('I', 'J') : -*spline_end_);
    spline_end_ = vector('P', 'Q');
    c = d + *spline_end_;
  } else {
    if (!(words_->has('I') || words_->has('J'))) place_.fail("G5.1 needs I or J");
    const Vec2 control = a + vector('I', 'J');
    b = (a + 2.0 * control) / 3.0, c = (d + 2.0 * control) / 3.0;
  }
  // Its second derivative is at most 6 times the larger second difference; a chord over 1/n deviates by 1/(8 n²) of
  // that.
  const double bend = 6 * std::max(glm::length(a - 2.0 * b + c), glm::length(b - 2.0 * c + d));
  const double parts = std::max(1.0, std::ceil(std::sqrt(bend / (8 * rows_->chord_tolerance()))));
  if (parts > kMaxChords) place_.fail("a spline with too many chords");
  const auto point = [&](double t) {
    const double s = 1 - t;
    return s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
  };
  double length = 0;
  for (int i = 1; i <= static_cast<int>(parts); ++i) length += glm::length(point(i / parts) - point((i - 1) / parts));
  Joints joints = at_;
  moves_in_part(false);
  rows_->curve(
      at_, static_cast<int>(parts), length,
      [&](double t) {
        if (t == 1) return to;
        const Vec2 p = point(t);
        joints[0] = p.x, joints[1] = p.y;
        return joints;
      },
      row_words(false));
  at_ = to;
}

/// R, Q and the depth are modal between cycles of one code.
void NcInterpreter::take_cycle_words(int code) {
  const char depth = kAxes[modes_.plane[2]];
  const bool first = code != cycle_.code;
  const auto need = [&](char letter, const char* what) {
    if (first && !words_->has(letter)) place_.fail(std::string("a canned cycle needs ") + letter + ", " + what);
  };
  need('R', "the height above which it moves fast");
  need(depth, "its depth");
  if (words_->has('R')) cycle_.retract = words_->value('R', kMaxLength) * modes_.unit;
  if (words_->has(depth)) cycle_.bottom = words_->value(depth, kMaxLength) * modes_.unit;
  if (code == 730 || code == 830) {
    need('Q', "the depth of a peck");
    if (words_->has('Q')) cycle_.peck = words_->value('Q', kMaxLength) * modes_.unit;
    if (!(cycle_.peck > 0)) place_.fail("Q must be positive");
  }
  // Fanuc's and Haas's controls accept a dwell in each drilling cycle.
  if (words_->has('P') && words_->value('P', 1e6) < 0) place_.fail("P is negative");
  if (is_tapping_cycle(code)) {
    words_->pass_over("J");
    cycle_.peck = words_->has('Q') ? words_->value('Q', kMaxLength) * modes_.unit : 0;
    if (cycle_.peck < 0) place_.fail("Q must be positive");
  }
  if (cycle_.code < 0) cycle_.level = at_[modes_.plane[2]];
  cycle_.code = code;
}

void NcInterpreter::drill_at(int code) {
  refuse_in_compensation("a canned cycle");
  if (modes_.feed_mode == 930) place_.fail("canned cycles do not support inverse time (G93)");
  for (const char letter : {'A', 'B', 'C'})
    if (words_->has(letter)) place_.fail("rotary axes do not turn in canned cycles");
  if (code == 860 && modes_.turning == 0) place_.fail("G86 needs a spindle that turns (M3, M4)");
  const auto [u, v, w] = modes_.plane;
  take_cycle_words(code);
  const int repeats = words_->has('L') ? words_->whole('L') : 1;
  if (repeats < 1) place_.fail("L must be at least 1");
  const double retract = cycle_.retract + (modes_.absolute ? 0 : cycle_.level);
  const double bottom = cycle_.bottom + (modes_.absolute ? 0 : retract);
  if (retract < bottom) place_.fail("the canned cycle's R is below its depth");
  // If the drilling axis is at a machine position, the first move in the part is the one to R.
  bool away = stand_[w] == Stand::Machine;
  if (away && (!modes_.absolute || modes_.return_level == 980)) check_stands_in_part("a canned cycle under G91 or G98");
  NcRowWords words = row_words(true);
  const auto go = [&](const Joints& to, bool rapid) {
    if (to == at_ && !away) return;
    words.rapid = rapid;
    straight_to(to, words);
  };
  const auto height = [&](double z) {
    Joints to = at_;
    to[w] = z;
    return to;
  };
  // Also from above R, if earlier cycles had a higher R: as in LinuxCNC.
  if (!away && cycle_.level < retract) go(height(retract), true);
  // The height to which G98 returns, and from which it starts.
  const double level = modes_.return_level == 980 ? std::max(cycle_.level, retract) : retract;
  for (int k = 0; k < repeats; ++k) {
    Joints to = away ? at_ : height(at_[w] > retract ? at_[w] : level);
    for (const std::size_t axis : {u, v}) {
      if (!words_->has(kAxes[axis])) continue;
      const double word = length_or_angle(axis);
      to[axis] = modes_.absolute ? word : at_[axis] + word;
      if (modes_.absolute) stand_[axis] = Stand::Given;
      if (!(std::abs(to[axis]) <= kMaxLength)) place_.fail(std::string(1, kAxes[axis]) + " is out of range");
    }
    go(to, true);
    stand_[w] = Stand::Given;
    go(height(retract), true);
    away = false;
    const double turning = words.spindle;
    const bool taps = is_tapping_cycle(code);
    const double cutting = code == 740 ? -modes_.speed : modes_.speed;
    drill({code, retract, bottom, level, cycle_.peck}, place_, [&](double z, bool rapid) {
      if (code == 860 && rapid) words.spindle = 0;
      if (taps) words.spindle = z > at_[w] && !rapid ? -cutting : cutting;
      go(height(z), rapid);
    });
    words.spindle = turning;
    if (rows_->pending().size() > kMaxChords) place_.fail("a canned cycle of too many moves: L is too large");
  }
}

}  // namespace riffler::nc
