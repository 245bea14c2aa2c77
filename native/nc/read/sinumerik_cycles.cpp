// Drilling cycles and hole patterns of Sinumerik programs.
#include <algorithm>
#include <cmath>
#include <string>

#include "base/functions.hpp"
#include "geom/directions.hpp"
#include "geom/math.hpp"
#include "nc/limits.hpp"
#include "nc/read/sinumerik_interpreter.hpp"

namespace riffler::nc {

namespace {

constexpr std::size_t kMaxArguments = 100;
constexpr double kMaxHoles = 100'000;
/// rad: allowed angle between tool and hole axis, for the rounding of printed angles.
constexpr double kAlong = 2e-3;

}  // namespace

bool SinumerikInterpreter::execute_cycle(const std::string& word, SinumerikCursor& cursor) {
  if (word == "CYCLE800") {
    swivel(cursor);
    return true;
  }
  const int number = number_of_cycle(word);
  const bool pattern = word == "HOLES1" || word == "HOLES2";
  if (!is_sinumerik_hole(number) && !pattern) return false;
  if (!cursor.take_if("(")) cursor.fail(word + " needs its parameters in brackets");
  const Arguments given = arguments(cursor);
  cursor.expect_end();
  if (pattern)
    holes(word, given);
  else
    drill(number, given);
  return true;
}

/// The arguments up to the closing bracket; no value for omitted ones and for texts.
SinumerikInterpreter::Arguments SinumerikInterpreter::arguments(SinumerikCursor& cursor) {
  Arguments out;
  if (cursor.take_if(")")) return out;
  while (true) {
    if (out.size() >= kMaxArguments) cursor.fail("too many arguments");
    const char c = cursor.peek();
    if (c == ',' || c == ')')
      out.emplace_back();
    else if (c == '"')
      cursor.quoted(), out.emplace_back();
    else
      out.emplace_back(values_.value(cursor, "an argument"));
    if (cursor.take_if(")")) return out;
    if (!cursor.take_if(",")) cursor.fail_unexpected();
  }
}

/// MCALL CYCLE81(...): call after each block that moves; MCALL alone ends that.
void SinumerikInterpreter::modal_call(SinumerikCursor& cursor) {
  modal_cycle_ = 0;
  if (cursor.peek() == '\0') return;
  const std::string name = cursor.name();
  const int number = number_of_cycle(name);
  refuse(is_sinumerik_hole(number) ? "" : name);
  if (!is_sinumerik_hole(number))
    place_.fail("MCALL " + name + " is not read: MCALL of drilling cycles is (CYCLE81 to CYCLE89, CYCLE840); call " +
                name + " at each place");
  if (!cursor.take_if("(")) cursor.fail(name + " needs its parameters in brackets");
  modal_arguments_ = arguments(cursor);
  cursor.expect_end();
  modal_cycle_ = number;
}

/// Drills at the tool's position in the plane.
void SinumerikInterpreter::drill(int number, const Arguments& given) {
  const auto [u, v, w] = plane_;
  if (stand_[u] == Stand::Machine || stand_[v] == Stand::Machine)
    place_.fail("a cycle while " + axes_away() + " is at a machine position: move into the part first");
  if (!keeps_tip_ && !is_upright()) fail_tilted();
  if (plane_[2] == 2 && geom::angle_between(rows_->machine().pose(rotary_).axis, frame_.turn[2]) > kAlong)
    place_.fail("a drilling cycle whose hole is not along the tool: have the CAM system write its moves");
  if (feed_mode_ == 93) place_.fail("drilling cycles do not support inverse time (G93)");
  const double feed = feed_mode_ == 95 ? feed_ * (surface_speed_ ? 0 : speed_) : feed_;
  if (!(feed <= kMaxFeed)) place_.fail("F is out of range");
  const SinumerikCycleSetting setting{unit_, feed_mode_ == 95 ? unit_ * speed_ : feed_unit_, feed, speed_, turning_};
  const Vec3 hole = at_;
  sinumerik_hole(number, setting, given, place_, [&](const HoleStroke& stroke) {
    const NcRowWords words{stroke.feed == 0,   stroke.feed, false, stroke.spindle.value_or(turning_ * speed_), tool_,
                           calls_.front().line};
    Vec3 to = hole;
    to[static_cast<int>(u)] += stroke.aside.x, to[static_cast<int>(v)] += stroke.aside.y;
    to[static_cast<int>(w)] = stroke.height;
    const bool away = stand_[w] == Stand::Machine;
    stand_[w] = Stand::Given;
    if (to != at_ || away) move_to(to, rotary_, words);
    if (rows_->pending().size() > kMaxChords) place_.fail("a drilling cycle of too many moves");
  });
  leaving_.reset();
}

/// HOLES1(SPCA, SPCO, STA1, FDIS, DBH, NUM): a row; HOLES2(CPA, CPO, RAD, STA1, INDA, NUM): on a circle.
void SinumerikInterpreter::holes(const std::string& word, const Arguments& given) {
  if (modal_cycle_ == 0) place_.fail(word + " without a modal cycle: MCALL CYCLE81(...) before it");
  if (!keeps_tip_ && !is_upright()) fail_tilted();
  const auto of = [&](std::size_t k) { return k < given.size() ? given[k].value_or(0) : 0; };
  for (std::size_t k = 0; k < given.size(); ++k)
    if (!(std::abs(of(k)) <= kMaxLength)) place_.fail("a number of " + word + " is out of range");
  const double count = of(5);
  if (!(count >= 1 && count <= kMaxHoles && count == std::floor(count)))
    place_.fail("NUM, the number of holes of " + word + ", must be a whole number of at least 1");
  const Vec2 origin = unit_ * Vec2(of(0), of(1));
  const int number = static_cast<int>(count);
  if (word == "HOLES1") {
    const double angle = of(2) * kDegree;
    const Vec2 along(base::cos(angle), base::sin(angle));
    const auto at = [&](int k) { return origin + unit_ * (of(3) + k * of(4)) * along; };
    const Vec2 here(at_[static_cast<int>(plane_[0])], at_[static_cast<int>(plane_[1])]);
    // Start from the nearer end.
    const bool back = glm::length(at(number - 1) - here) < glm::length(at(0) - here);
    for (int k = 0; k < number; ++k) hole_at(at(back ? number - 1 - k : k));
    return;
  }
  const double radius = of(2) * unit_, step = of(4) != 0 ? of(4) : 360 / count;
  if (!(radius > 0)) place_.fail("RAD, the radius of HOLES2, must be positive");
  for (int k = 0; k < number; ++k) {
    const double angle = (of(3) + k * step) * kDegree;
    hole_at(origin + radius * Vec2(base::cos(angle), base::sin(angle)));
  }
}

void SinumerikInterpreter::hole_at(const Vec2& at) {
  const auto [u, v, w] = plane_;
  Vec3 to = at_;
  to[static_cast<int>(u)] = at.x, to[static_cast<int>(v)] = at.y;
  stand_[u] = stand_[v] = Stand::Given;
  move_to(to, rotary_, {true, 0, false, turning_ * speed_, tool_, calls_.front().line});
  drill(modal_cycle_, modal_arguments_);
}

}  // namespace riffler::nc
