#include "nc/read/heidenhain_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "nc/limits.hpp"

namespace riffler::nc {

namespace {

constexpr double kMaxHoleStrokes = 100'000;
/// mm: a smaller remainder is not a separate peck.
constexpr double kRest = 1e-9;

class Hole {
 public:
  Hole(const HeidenhainCycleSetting& setting, const HeidenhainValues& values, const NcPlace& place,
       const std::function<void(const HoleStroke&)>& move)
      : setting_(setting), values_(values), place_(place), move_(move) {}

  void run(int number) {
    if (number == 1) return old_pecking();
    if (number == 2) return old_tapping();
    const double depth = length(201, "its depth");
    if (depth > 0)
      place_.fail(std::string("Q201, the depth of cycle ") + std::to_string(number) + ", must be negative");
    if (depth == 0) return;  // as on the control: the cycle is not executed
    surface_ = length(203, "the coordinate of the surface");
    clear_ = surface_ + length(200, "the set-up clearance");
    level_ = std::max(clear_, surface_ + length(204, "the second set-up clearance"));
    bottom_ = surface_ + depth;
    if (clear_ < bottom_) place_.fail("Q200, the set-up clearance, is below the depth");
    rapid(clear_);
    switch (number) {
      case 200:
        return drill();
      case 201:
        return ream();
      case 202:
        return bore();
      case 203:
        return drill_with_breaks();
      case 205:
        return peck();
      case 241:
        return drill_deep();
      default:
        return tap(number);
    }
  }

 private:
  double length(int q, const char* what) const {
    const double value = values_.needed(q, what) * setting_.unit;
    if (!(std::abs(value) <= kMaxLength)) place_.fail(std::string("Q") + std::to_string(q) + " is out of range");
    return value;
  }
  double length_or(int q, const char* what, double otherwise) const {
    return values_.has(q) ? length(q, what) : otherwise;
  }
  /// Feed in mm/min; 0 for FMAX.
  double feed(int q, const char* what) const {
    const double value = values_.needed(q, what);
    if (value >= kHeidenhainFmax) return 0;
    const double out = value * setting_.feed_unit;
    if (!(out >= 0 && out <= kMaxFeed)) place_.fail(std::string("Q") + std::to_string(q) + " is out of range");
    return out;
  }
  double drilling_feed() const {
    const double out = feed(206, "the feed");
    if (!(out > 0)) place_.fail("Q206, the feed of the cycle, must be positive");
    return out;
  }
  /// Q208: 0 means the drilling feed.
  double retraction_feed(double drilling) const {
    if (!values_.has(208)) return drilling;
    if (values_.needed(208, "the feed of the retraction") >= kHeidenhainFmax) return 0;
    const double out = feed(208, "the feed of the retraction");
    return out > 0 ? out : drilling;
  }
  double plunging_depth(double of) const {
    const double step = length(202, "the depth of a peck");
    if (!(step > 0)) place_.fail("Q202, the depth of a peck, must be positive");
    if (!(of / step <= kMaxHoleStrokes)) place_.fail("Q202 is too small: too many pecks");
    return step;
  }

  void stroke(double height, double feed) { move_({height, feed, spindle_, aside_}); }
  void rapid(double height) { stroke(height, 0); }
  void leave() {
    if (level_ > clear_) rapid(level_);
  }

  void drill() {
    const double f = drilling_feed(), step = plunging_depth(surface_ - bottom_);
    for (double to = surface_ - step; to > bottom_ + kRest; to -= step) {
      stroke(to, f);
      rapid(clear_);
      rapid(std::min(to + (clear_ - surface_), clear_));
    }
    stroke(bottom_, f);
    rapid(level_);
  }

  void ream() {
    const double f = drilling_feed();
    stroke(bottom_, f);
    stroke(clear_, retraction_feed(f));
    leave();
  }

  /// Retracts with the spindle stopped and the edge moved off the wall, to the side that Q214 names.
  void bore() {
    const double f = drilling_feed(), out = retraction_feed(f);
    const double side = values_.has(214) ? values_.needed(214, "the direction of disengaging") : 0;
    const double off = length_or(357, "the clearance to the side", 0.2 * setting_.unit);
    if (!(side == 0 || side == 1 || side == 2 || side == 3 || side == 4))
      place_.fail("Q214, the direction of disengaging, must be 0 to 4");
    stroke(bottom_, f);
    spindle_ = 0;
    if (side > 0) {
      const double by = side < 3 ? -off : off;
      aside_ = side == 1 || side == 3 ? Vec2(by, 0) : Vec2(0, by);
      stroke(bottom_, f);
    }
    stroke(clear_, out);
    leave();
    aside_ = Vec2(0), spindle_.reset();
    if (side > 0) rapid(level_);
  }

  /// Steps that shrink by Q212 down to Q205.
  double next_step(double step) const {
    const double by = length_or(212, "the decrement", 0);
    return by > 0 ? std::max({step - by, length_or(205, "the least depth of a peck", 0), 1e-3}) : step;
  }

  void drill_with_breaks() {
    const double f = drilling_feed(), out = retraction_feed(f),
                 back = length_or(256, "the retraction of a chip break", 0.2);
    const double most = values_.has(213) ? values_.needed(213, "the number of chip breaks") : 0;
    double step = plunging_depth(surface_ - bottom_), breaks = 0, strokes = 0;
    for (double to = surface_ - step; to > bottom_ + kRest; to -= step) {
      if (++strokes > kMaxHoleStrokes) place_.fail("too many pecks");
      stroke(to, f);
      if (breaks < most) {
        ++breaks;
        rapid(std::min(to + back, clear_));
      } else {
        breaks = 0;
        stroke(clear_, out);
        rapid(std::min(to + (clear_ - surface_), clear_));
      }
      step = next_step(step);
    }
    stroke(bottom_, f);
    stroke(clear_, out);
    leave();
  }

  void peck() {
    const double f = drilling_feed();
    const double start = surface_ - length_or(379, "the deepened starting point", 0);
    if (start < bottom_) place_.fail("Q379, the deepened starting point, is below the depth");
    if (start < surface_) stroke(start + (clear_ - surface_), feed(253, "the feed of positioning"));
    std::vector<double> ends;
    double step = plunging_depth(start - bottom_);
    for (double to = start - step; to > bottom_ + kRest; to -= step, step = next_step(step)) {
      if (static_cast<double>(ends.size()) > kMaxHoleStrokes) place_.fail("too many pecks");
      ends.push_back(to);
    }
    ends.push_back(bottom_);
    const double first = length_or(258, "the upper stop distance", 0.2), last = length_or(259, "the lower one", first);
    double from = start;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      break_chips(from, ends[k], f);
      if (k + 1 == ends.size()) break;
      const double share = ends.size() > 2 ? static_cast<double>(k) / static_cast<double>(ends.size() - 2) : 0;
      rapid(clear_);
      rapid(std::min(ends[k] + first + share * (last - first), clear_));
      from = ends[k];
    }
    rapid(clear_);
    leave();
  }

  /// One peck, with chip breaking every Q257.
  void break_chips(double from, double to, double feed) {
    const double every = length_or(257, "the depth of a chip break", 0);
    const double back = length_or(256, "the retraction of a chip break", 0.2);
    if (every > 0) {
      if (!((from - to) / every <= kMaxHoleStrokes)) place_.fail("Q257 is too small: too many chip breaks");
      for (double at = from - every; at > to + kRest; at -= every) {
        stroke(at, feed);
        rapid(std::min(at + back, clear_));
      }
    }
    stroke(to, feed);
  }

  /// Single-lip deep hole: in and out with the spindle speed and direction given for that.
  void drill_deep() {
    const double f = drilling_feed(), start = surface_ - length_or(379, "the deepened starting point", 0);
    if (start < bottom_) place_.fail("Q379, the deepened starting point, is below the depth");
    const double sense = values_.has(426) ? values_.needed(426, "the sense of rotation") : 3;
    const double slow = values_.has(427) ? values_.needed(427, "the speed of entry") : setting_.speed;
    const double moving = sense == 5 ? 0 : sense == 4 ? -slow : slow;
    spindle_ = checked_speed(moving);
    if (start < surface_) stroke(start, feed(253, "the feed of positioning"));
    spindle_ = checked_speed(values_.has(428) ? values_.needed(428, "the speed of drilling") : setting_.speed);
    stroke(bottom_, f);
    spindle_ = checked_speed(moving);
    stroke(clear_, retraction_feed(f));
    leave();
  }

  double checked_speed(double speed) const {
    if (!(std::abs(speed) <= kMaxSpindle)) place_.fail("a speed of cycle 241 is out of range");
    return speed;
  }

  /// With a floating holder (206) by its feed, rigid (207, 209) by its pitch; out with reversed spindle.
  void tap(int number) {
    double f = 0, sense = 1;
    if (number == 206) {
      f = drilling_feed();
    } else {
      const double pitch = length(239, "the pitch");
      if (!(setting_.speed > 0))
        place_.fail("a rigid tapping cycle without a spindle speed S: its feed is pitch times speed");
      f = std::abs(pitch) * setting_.speed, sense = pitch < 0 ? -1 : 1;
    }
    if (!(f > 0 && f <= kMaxFeed)) place_.fail("the feed of the tapping cycle is 0 or out of range");
    const double in = sense * setting_.speed;
    if (number == 209) break_tap(f, in);
    spindle_ = in;
    stroke(bottom_, f);
    spindle_ = -in;
    stroke(clear_, f);
    spindle_ = in;
    leave();
  }

  /// Retracts by some pitches, or completely, every Q257.
  void break_tap(double feed, double in) {
    const double every = length(257, "the depth of a chip break");
    const double back = values_.needed(256, "the retraction of a chip break") * std::abs(length(239, "the pitch"));
    if (every <= 0) return;
    if (!((surface_ - bottom_) / every <= kMaxHoleStrokes)) place_.fail("Q257 is too small: too many chip breaks");
    for (double to = surface_ - every; to > bottom_ + kRest; to -= every) {
      spindle_ = in;
      stroke(to, feed);
      spindle_ = -in;
      stroke(back > 0 ? std::min(to + back, clear_) : clear_, feed);
    }
  }

  /// Cycle 2, with a floating holder: from the tool's position, which is the set-up clearance above the surface.
  void old_tapping() {
    for (const std::size_t k : {0U, 1U, 3U})
      if (!setting_.old[k]) place_.fail(std::string("cycle 2 without its part 2.") + std::to_string(k + 1));
    const double start = setting_.height, f = *setting_.old[3] * setting_.feed_unit;
    const double bottom = start - std::abs(*setting_.old[0]) * setting_.unit + *setting_.old[1] * setting_.unit;
    if (*setting_.old[1] > 0) place_.fail("the depth of cycle 2 must be negative");
    if (!(f > 0 && f <= kMaxFeed && std::abs(bottom) <= kMaxLength)) place_.fail("a number of cycle 2 is out of range");
    if (*setting_.old[1] == 0) return;
    stroke(bottom, f);
    spindle_ = -setting_.speed;
    stroke(start, f);
  }

  /// Cycle 1: from the tool's position, which is the set-up clearance above the surface.
  void old_pecking() {
    for (const std::size_t k : {0U, 1U, 2U, 4U})
      if (!setting_.old[k]) place_.fail(std::string("cycle 1 without its part 1.") + std::to_string(k + 1));
    const double clearance = std::abs(*setting_.old[0]) * setting_.unit, depth = -*setting_.old[1] * setting_.unit;
    const double step = std::abs(*setting_.old[2]) * setting_.unit, f = *setting_.old[4] * setting_.feed_unit;
    if (depth < 0) place_.fail("the depth of cycle 1 must be negative");
    if (depth == 0) return;
    if (!(step > 0 && depth / step <= kMaxHoleStrokes)) place_.fail("the depth of a peck of cycle 1 is too small");
    if (!(f > 0 && f <= kMaxFeed && clearance <= kMaxLength && depth <= kMaxLength))
      place_.fail("a number of cycle 1 is out of range");
    const double start = setting_.height, surface = start - clearance, bottom = surface - depth;
    // Distance that the control keeps from the previous bottom: 0.6 mm, or a fiftieth of holes deeper than 30 mm, at
    // most 7 mm.
    const double stop = std::min(std::max(0.6, depth / 50), 7.0);
    for (double to = surface - step; to > bottom + kRest; to -= step) {
      stroke(to, f);
      rapid(start);
      rapid(std::min(to + stop, start));
    }
    stroke(bottom, f);
    rapid(start);
  }

  const HeidenhainCycleSetting& setting_;
  const HeidenhainValues& values_;
  const NcPlace& place_;
  const std::function<void(const HoleStroke&)>& move_;
  double surface_ = 0, clear_ = 0, level_ = 0, bottom_ = 0;
  std::optional<double> spindle_;
  Vec2 aside_{0};
};

}  // namespace

bool is_heidenhain_hole(int number) {
  constexpr int kHoles[] = {1, 2, 200, 201, 202, 203, 205, 206, 207, 209, 241};
  return std::ranges::find(kHoles, number) != std::end(kHoles);
}

void heidenhain_hole(int number, const HeidenhainCycleSetting& setting, const HeidenhainValues& values,
                     const NcPlace& place, const std::function<void(const HoleStroke&)>& move) {
  Hole(setting, values, place, move).run(number);
}

}  // namespace riffler::nc
