#include "nc/read/sinumerik_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "nc/limits.hpp"

namespace riffler::nc {

namespace {

constexpr double kMaxStrokes = 100'000;
/// mm: a smaller remainder is not a separate peck.
constexpr double kNoPeck = 1e-9;

/// Pitches of metric coarse threads (ISO 261), mm.
struct Thread {
  double size, pitch;
};
constexpr Thread kThreads[] = {{3, 0.5},  {4, 0.7},  {5, 0.8},  {6, 1},    {8, 1.25}, {10, 1.5}, {12, 1.75},
                               {14, 2},   {16, 2},   {18, 2.5}, {20, 2.5}, {22, 2.5}, {24, 3},   {27, 3},
                               {30, 3.5}, {33, 3.5}, {36, 4},   {39, 4},   {42, 4.5}, {45, 4.5}, {48, 5}};

class SinumerikHole {
 public:
  SinumerikHole(int number, const SinumerikCycleSetting& setting, const std::vector<std::optional<double>>& parameters,
                const NcPlace& place, const std::function<void(const HoleStroke&)>& move)
      : number_(number), setting_(setting), parameters_(parameters), place_(place), move_(move) {}

  void run() {
    take_heights();
    rapid(clear_);
    switch (number_) {
      case 81:
      case 82:
        drill();
        break;
      case 83:
        peck();
        break;
      case 84:
        tap();
        break;
      case 840:
        tap_with_chuck();
        break;
      case 85:
        ream();
        break;
      case 86:
        bore();
        break;
      case 89:
        stroke(bottom_, feed());
        stroke(clear_, feed());
        break;
      default:  // 87, 88: the spindle stops before the tool goes out
        stroke(bottom_, feed());
        spindle_ = 0;
    }
    if (number_ == 87 || number_ == 88) rapid(level_), spindle_.reset();
    rapid(level_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    place_.fail(std::string("CYCLE") + std::to_string(number_) + ": " + what);
  }

  bool has(std::size_t k) const { return k < parameters_.size() && parameters_[k].has_value(); }
  double number(std::size_t k) const { return has(k) ? *parameters_[k] : 0; }
  double length(std::size_t k, const char* name) const {
    const double out = number(k) * setting_.unit;
    if (!(std::abs(out) <= kMaxLength)) fail(std::string(name) + " is out of range");
    return out;
  }

  /// RTP, RFP, SDIS, and DP or DPR.
  void take_heights() {
    level_ = length(0, "RTP, the retraction plane,"), surface_ = length(1, "RFP, the reference plane,");
    const double clearance = length(2, "SDIS, the safety clearance,");
    bottom_ = length(3, "DP, the depth,");
    const double relative = length(4, "DPR, the depth from the reference plane,");
    if (relative < 0 || clearance < 0) fail("SDIS and DPR have no sign");
    if (!has(3) && relative == 0) fail("neither DP nor DPR, its depth, is given");
    if (relative > 0) {
      if (number(3) != 0 && std::abs(surface_ - relative - bottom_) > 1e-6)
        fail("DP and DPR name different depths: leave one of them out");
      bottom_ = surface_ - relative;
    }
    clear_ = surface_ + clearance;
    if (level_ < surface_ || bottom_ > surface_)
      fail(
          "holes upwards are not read: the retraction plane (RTP) must be above the reference plane (RFP), the depth "
          "below it");
    level_ = std::max(level_, clear_);
  }

  double feed() const {
    if (!(setting_.feed > 0)) fail("a drilling cycle without F");
    return setting_.feed;
  }
  double own_feed(std::size_t k, const char* name) const {
    if (number(k) == 0) return feed();
    const double out = number(k) * setting_.feed_unit;
    if (!(out > 0 && out <= kMaxFeed)) fail(std::string(name) + " is negative or out of range");
    return out;
  }
  void stroke(double height, double feed) { move_({height, feed, spindle_, aside_}); }
  void rapid(double height) { stroke(height, 0); }

  void drill() { stroke(bottom_, feed()); }

  void ream() {
    stroke(bottom_, own_feed(6, "FFR, the feed,"));
    stroke(clear_, own_feed(7, "RFF, the feed of the retraction,"));
  }

  /// The depths of CYCLE83's pecks, each relative to the one before: decreasing by DAM, or by a factor.
  std::vector<double> depths() const {
    std::vector<double> out;
    const double first = number(6) != 0             ? surface_ - length(6, "FDPR, the first depth,")
                         : has(5) && number(5) != 0 ? length(5, "FDEP, the first depth,")
                                                    : bottom_;
    if (first > surface_ || first < bottom_ - kNoPeck) fail("the first depth (FDEP, FDPR) is not within the hole");
    const double by = number(7), least = std::max(length(13, "_MDEP, the least depth of a peck,"), 0.0);
    double step = surface_ - first, at = first;
    if (!(step > kNoPeck) && bottom_ < surface_ - kNoPeck) fail("the first depth (FDEP, FDPR) is 0");
    while (at > bottom_ + kNoPeck) {
      if (static_cast<double>(out.size()) > kMaxStrokes) fail("too many pecks");
      out.push_back(at);
      const double rest = at - bottom_;
      if (by < 0)
        step = std::max({step * std::min(-by, 1.0), least, 1e-3});
      else if (by > 0) {
        const double amount = by * setting_.unit;
        step = step - amount > amount ? step - amount : amount;
        // The last two pecks are equal.
        if (rest > step && rest < 2 * amount) step = rest / 2;
      }
      at -= step;
    }
    out.push_back(bottom_);
    return out;
  }

  void peck() {
    const bool clears = number(11) != 0;
    const double factor = number(10) > 0 ? number(10) : 1, back = has(14) && number(14) > 0 ? length(14, "_VRT")
                                                                  : setting_.unit == 1      ? 1
                                                                                            : 0.04 * kInch;
    if (!(factor <= 1)) fail("FRF, the factor of the first feed, is above 1");
    const double depth = surface_ - bottom_;
    // Distance that the control keeps from the previous bottom: 0.6 mm, or a fiftieth of holes deeper than 30 mm, at
    // most 7 mm.
    const double stop = number(16) > 0 ? length(16, "_DIS1") : std::min(std::max(0.6, depth / 50), 7.0);
    double before = clear_, slow = factor;
    for (const double at : depths()) {
      if (before < clear_) rapid(std::min(before + (clears ? stop : 0), clear_));
      stroke(at, feed() * slow);
      slow = 1;
      if (at <= bottom_ + kNoPeck) break;
      rapid(clears ? clear_ : std::min(at + back, clear_));
      before = clears ? at : std::min(at + back, clear_);
    }
  }

  /// Pitch in mm, > 0 right-handed: from the thread's size or given directly; 0 if neither is given.
  double pitch(std::size_t size, std::size_t given, std::size_t unit) const {
    double out = number(given) * setting_.unit;
    if (number(unit) == 1) out = number(given);
    if (number(unit) == 2 && number(given) != 0) out = kInch / number(given);
    if (number(unit) == 3) out = number(given) * kInch;
    const double thread = std::abs(number(size));
    if (thread == 0) return out;
    const auto found = std::ranges::find(kThreads, thread, &Thread::size);
    if (found == std::end(kThreads)) fail("MPIT, the thread's size, is not one of M3 to M48: write PIT, its pitch");
    if (out != 0 && std::abs(std::abs(out) - found->pitch) > 1e-6) fail("MPIT and PIT are of different threads");
    return std::copysign(found->pitch, number(size));
  }

  /// Rigid, with its own speed; out with the spindle reversed.
  void tap() {
    const double rise = pitch(7, 8, 13), speed = number(10) != 0 ? number(10) : setting_.speed;
    const double out = number(11) != 0 ? number(11) : speed;
    if (rise == 0) fail("neither MPIT nor PIT, the thread's pitch, is given");
    if (!(speed > 0 && speed <= kMaxSpindle && out > 0 && out <= kMaxSpindle)) fail("SST, the speed, is missing");
    const double sense = rise < 0 ? -1 : 1, in_feed = std::abs(rise) * speed, out_feed = std::abs(rise) * out;
    if (!(in_feed <= kMaxFeed && out_feed <= kMaxFeed)) fail("pitch times speed is out of range");
    const double step = number(15) != 0 ? length(16, "_DAM") : 0, back = length(17, "_VRT");
    const bool clears = number(15) == 2;
    if (step > 0) {
      if (!((surface_ - bottom_) / step <= kMaxStrokes)) fail("too many pecks");
      for (double at = surface_ - step; at > bottom_ + kNoPeck; at -= step) {
        spindle_ = sense * speed;
        stroke(at, in_feed);
        spindle_ = -sense * out;
        stroke(clears || back <= 0 ? clear_ : std::min(at + back, clear_), out_feed);
      }
    }
    spindle_ = sense * speed;
    stroke(bottom_, in_feed);
    spindle_ = -sense * out;
    stroke(clear_, out_feed);
    const double after = number(6);
    spindle_ = after == 3 ? speed : after == 4 ? -speed : after == 5 ? 0 : setting_.turning * setting_.speed;
  }

  /// With a compensating chuck: feed from the pitch, or from F.
  void tap_with_chuck() {
    const double rise = std::abs(pitch(9, 10, 99));
    const double f = rise > 0 && number(8) == 0 ? rise * setting_.speed : feed();
    if (!(f > 0 && f <= kMaxFeed)) fail("pitch times speed is 0 or out of range");
    const double turning = setting_.turning != 0 ? setting_.turning * setting_.speed : setting_.speed;
    spindle_ = turning;
    stroke(bottom_, f);
    spindle_ = -turning;
    stroke(clear_, f);
    spindle_ = turning;
  }

  /// Retracts with the spindle stopped and the edge off the wall.
  void bore() {
    if (number(6) == 3 || number(6) == 4) spindle_ = (number(6) == 3 ? 1 : -1) * setting_.speed;
    stroke(bottom_, feed());
    spindle_ = 0;
    aside_ = {length(7, "RPA"), length(8, "RPO")};
    const double lift = length(9, "RPAP");
    if (lift < 0) fail("RPAP, the lift at the ground, is negative");
    if (aside_ != Vec2(0) || lift > 0) rapid(std::min(bottom_ + lift, level_));
    rapid(level_);
    aside_ = Vec2(0), spindle_.reset();
  }

  int number_;
  const SinumerikCycleSetting& setting_;
  const std::vector<std::optional<double>>& parameters_;
  const NcPlace& place_;
  const std::function<void(const HoleStroke&)>& move_;
  double level_ = 0, surface_ = 0, clear_ = 0, bottom_ = 0;
  std::optional<double> spindle_;
  Vec2 aside_{0};
};

}  // namespace

int number_of_cycle(std::string_view name) {
  if (!name.starts_with("CYCLE") || name.size() < 7 || name.size() > 8) return 0;
  int out = 0;
  for (const char c : name.substr(5)) {
    if (c < '0' || c > '9') return 0;
    out = 10 * out + (c - '0');
  }
  return out;
}

bool is_sinumerik_hole(int number) {
  return (number >= 81 && number <= 89) || number == 840;
}

void sinumerik_hole(int number, const SinumerikCycleSetting& setting,
                    const std::vector<std::optional<double>>& parameters, const NcPlace& place,
                    const std::function<void(const HoleStroke&)>& move) {
  SinumerikHole(number, setting, parameters, place, move).run();
}

}  // namespace riffler::nc
