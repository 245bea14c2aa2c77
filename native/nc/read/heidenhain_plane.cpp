// Tilted working planes of Heidenhain programs: PLANE, cycle 19.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/directions.hpp"
#include "geom/math.hpp"
#include "nc/limits.hpp"
#include "nc/number_text.hpp"
#include "nc/read/heidenhain_interpreter.hpp"
#include "nc/read/tool_axis.hpp"

namespace riffler::nc {

namespace {

/// rad, deg: tolerance between printed axis angles and the plane's normal.
constexpr double kUpright = 1e-3, kSameAngle = 0.06;
/// Within this angle (rad) of the pole a rotary axis is free.
constexpr double kAtPole = 1e-6;

}  // namespace

void HeidenhainInterpreter::plane(HeidenhainCursor& cursor) {
  if (cursor.take_word("RESET")) return untilt(plane_words(cursor));
  const auto angle = [&](std::string_view name) {
    if (!cursor.take_word(name)) cursor.fail(std::string("PLANE without ") + std::string(name));
    const double value = values_.value(cursor, name);
    if (!(std::abs(value) <= kMaxAngle)) cursor.fail(std::string(name) + " is out of range");
    return value;
  };
  Mat3 turn(1);
  if (cursor.take_word("SPATIAL")) {
    const double a = angle("SPA"), b = angle("SPB"), c = angle("SPC");
    turn = spatial_turn({a, b, c});
  } else if (cursor.take_word("EULER")) {
    const double precession = angle("EULPR"), nutation = angle("EULNU"), rotation = angle("EULROT");
    turn = spatial_turn({0, 0, precession}) * spatial_turn({nutation, 0, 0}) * spatial_turn({0, 0, rotation});
  } else if (cursor.take_word("RELATIV")) {
    Vec3 by(0);
    for (const char axis : {'A', 'B', 'C'}) {
      const char name[] = {'S', 'P', axis};
      if (cursor.take_word({name, 3})) by[axis - 'A'] = values_.value(cursor, {name, 3});
    }
    turn = frame_.turn * spatial_turn(by);
  } else if (cursor.take_word("VECTOR")) {
    const double bx = angle("BX"), by = angle("BY"), bz = angle("BZ");
    const double nx = angle("NX"), ny = angle("NY"), nz = angle("NZ");
    const Vec3 base(bx, by, bz), normal(nx, ny, nz);
    const Vec3 along = base - glm::dot(base, normal) / std::max(glm::dot(normal, normal), 1e-300) * normal;
    if (!(glm::length(normal) > 1e-3 && glm::length(along) > 1e-3))
      cursor.fail("PLANE VECTOR whose vectors are 0 or parallel");
    const Vec3 x = glm::normalize(along), z = glm::normalize(normal);
    turn = Mat3(x, glm::cross(z, x), z);
  } else {
    cursor.fail("PLANE is read with SPATIAL, EULER, VECTOR, RELATIV and RESET: have the post write PLANE SPATIAL");
  }
  tilt(turn, plane_words(cursor));
}

HeidenhainInterpreter::PlaneWords HeidenhainInterpreter::plane_words(HeidenhainCursor& cursor) {
  PlaneWords words;
  const auto sign = [&] {
    if (cursor.take_if('+')) return 1;
    if (!cursor.take_if('-')) cursor.fail("SEQ needs + or -");
    return -1;
  };
  while (cursor.peek() != '\0') {
    if (cursor.take_word("STAY")) {
      words.positioning = Positioning::Stay;
    } else if (cursor.take_word("TURN")) {
      words.positioning = Positioning::Turn;
    } else if (cursor.take_word("MOVE")) {
      words.positioning = Positioning::Move;
    } else if (cursor.take_word("SEQ")) {
      words.sequence = sign();
    } else if (cursor.take_word("SYM")) {
      sign();
    } else if (cursor.take_word("TABLE ROT")) {
      words.turns_table = true;
    } else if (cursor.take_word("COORD ROT")) {
      words.turns_table = false;
    } else if (cursor.take_word("DIST") || cursor.take_word("ABST")) {
      values_.value(cursor, "DIST");
    } else if (cursor.take_word("MB")) {
      words.retraction.given = true;
      if (cursor.take_word("MAX"))
        words.retraction.to_limit = true;
      else
        words.retraction.distance = values_.value(cursor, "MB");
    } else if (cursor.peek() == 'F') {
      HeidenhainWords feed;
      feed.read_feed(cursor, values_);
      if (feed.feed == HeidenhainFeed::Number) words.feed = feed.feed_number * feed_unit_;
    } else {
      cursor.fail_unexpected();
    }
  }
  return words;
}

/// Cycle 19: angles A B C, taken as those of PLANE SPATIAL or as axis positions, depending on the machine's setup.
void HeidenhainInterpreter::old_plane(HeidenhainCursor& cursor) {
  HeidenhainWords words;
  words.read(cursor, values_, 0);
  if (words.has_linear()) place_.fail("cycle 19 takes A B C");
  Vec3 angles(0);
  bool all = true, none = true;
  for (int k = 0; k < 3; ++k) {
    const HeidenhainCoordinate& angle = words.axes[static_cast<std::size_t>(3 + k)];
    all &= angle.given, none &= angle.value == 0;
    angles[k] = angle.value;
  }
  if (none) return untilt({});
  if (!all)
    place_.fail(
        "cycle 19 without all of A B C may mean the places of the rotary axes, or angles in space, as the machine is "
        "set "
        "up: have the post write PLANE SPATIAL");
  tilt(spatial_turn(angles), {});
}

void HeidenhainInterpreter::use_frame(const HeidenhainFrame& frame) {
  if (frame == frame_) return;
  refuse_in_compensation("another place or tilt of the coordinates");
  stay_beside_contour();
  const Vec3 part = frame_.to_part(at_);
  const bool turns = !(frame.turn == frame_.turn && frame.rotation == frame_.rotation);
  frame_ = frame;
  at_ = frame_.from_part(part);
  check_length(at_);
  leaving_.reset(), pole_.reset();
  if (!turns) return;
  // Each coordinate of the new plane depends on all previous ones.
  if (is_away()) lose_place();
  if (std::ranges::find(stand_, Stand::Start) != stand_.end()) stand_.fill(Stand::Start);
}

void HeidenhainInterpreter::tilt(const Mat3& turn, const PlaneWords& words) {
  HeidenhainFrame frame = frame_;
  frame.turn = turn, frame.tilted = true;
  if (!(frame == frame_) && (frame_.plane_shift != Vec3(0) || frame_.rotation != 0))
    place_.fail("a plane is tilted while a datum shift made in another plane, or a rotation, holds: end that before");
  retract(words.retraction, 0);
  use_frame(frame);
  const Joints joints = plane_joints(words);
  plane_joints_ = joints;
  set_plane_parameters(joints);
  position(joints, words);
}

void HeidenhainInterpreter::untilt(const PlaneWords& words) {
  if (frame_.tilted && (frame_.plane_shift != Vec3(0) || frame_.rotation != 0))
    place_.fail("PLANE RESET while a datum shift or a rotation made in the plane holds: end that before");
  retract(words.retraction, 0);
  HeidenhainFrame frame = frame_;
  frame.turn = Mat3(1), frame.tilted = false;
  use_frame(frame);
  plane_joints_.reset();
  set_plane_parameters({});
  Joints joints{};
  for (std::size_t k = 3; k < joints.size(); ++k) joints[k] = nearest_turn(0, rotary_[k]);
  position(joints, words);
}

/// Joints that hold the tool along the plane's normal: the nearest, or the one on the side named by SEQ, judged by the
/// axis closest to the tool.
Joints HeidenhainInterpreter::plane_joints(const PlaneWords& words) const {
  const Machine& machine = rows_->machine();
  const Vec3 normal = frame_.normal();
  Joints near = rotary_;
  const bool two = machine.branches() == 2;
  const bool at_pole = two && glm::length(glm::cross(machine.pole(), normal)) < kAtPole;
  if (at_pole && words.turns_table) {
    const double angle = base::atan2(frame_.turn[0].y, frame_.turn[0].x) / kDegree;
    const std::size_t free = machine.free_joint();
    near[free] = nearest_turn(machine.pole().z < 0 ? -angle : angle, rotary_[free]);
  }
  const auto side = [&](const Joints& joints) {
    double out = 0;
    for (const char letter : machine.axes().substr(3))
      if (!two || joint_index(letter) != machine.free_joint()) out = nearest_turn(joints[joint_index(letter)], 0);
    return out;
  };
  std::optional<Joints> best;
  double best_cost = 0;
  try {
    for (int branch = 0; branch < machine.branches(); ++branch) {
      const Joints joints = machine.joints({Vec3(0), normal}, branch, near, kAtPole);
      double cost = 0;
      for (std::size_t k = 3; k < joints.size(); ++k) cost += std::abs(joints[k] - rotary_[k]);
      if (words.sequence * side(joints) < -kSameAngle) cost += 1e9;
      if (!best || cost < best_cost) best = joints, best_cost = cost;
    }
  } catch (const std::invalid_argument& e) {
    place_.fail(std::string(e.what()) + " of the tilted plane: read it with the machine that the program is for");
  }
  return *best;
}

void HeidenhainInterpreter::position(const Joints& joints, const PlaneWords& words) {
  if (words.positioning == Positioning::Stay) return;
  bool turns = false;
  for (std::size_t k = 3; k < joints.size(); ++k) turns |= joints[k] != rotary_[k];
  if (!turns) return;
  refuse_in_compensation("PLANE");
  stay_beside_contour();
  NcRowWords row{words.feed == 0, words.feed, false, turning_ * speed_, tool_, place_.line};
  const bool known = !is_away();
  if (words.positioning == Positioning::Turn || !known) {
    lose_place();
    rotary_ = joints;
    return leave_part(row);
  }
  rows_->line(in_part(at_, rotary_), in_part(at_, joints), row);
  rotary_ = joints;
}

/// Q120 to Q122: the target positions of A B C.
void HeidenhainInterpreter::set_plane_parameters(const Joints& joints) {
  for (int k = 0; k < 3; ++k) values_.set(120 + k, joints[static_cast<std::size_t>(3 + k)]);
}

/// Whether the rotary axes stand such that X Y Z of the working plane are the tip without M128.
bool HeidenhainInterpreter::is_upright() const {
  const Machine& machine = rows_->machine();
  if (!plane_joints_) {
    for (std::size_t k = 3; k < rotary_.size(); ++k)
      if (!is_whole_turn(rotary_[k])) return false;
    return true;
  }
  Joints joints = rotary_;
  if (geom::angle_between(machine.pose(joints).axis, frame_.normal()) > kUpright) return false;
  if (machine.branches() < 2 || glm::length(glm::cross(machine.pole(), frame_.normal())) >= kUpright) return true;
  return is_whole_turn(rotary_[machine.free_joint()] - (*plane_joints_)[machine.free_joint()]);
}

void HeidenhainInterpreter::fail_tilted() const {
  const auto shown = [&](const Joints& joints) {
    std::string out;
    for (const char letter : rows_->machine().axes().substr(3)) {
      if (!out.empty()) out += ' ';
      out += letter;
      out += number_text(joints[joint_index(letter)], 3);
    }
    return out;
  };
  if (plane_joints_)
    place_.fail("the rotary axes stand at " + shown(rotary_) + ", the tilted plane needs " + shown(*plane_joints_) +
                ": turn them there (by Q120 to Q122, or PLANE with TURN), or read it with the machine that the program "
                "is for");
  place_.fail("a feed move with the rotary axes at " + shown(rotary_) +
              ", without M128 and without a tilted plane: where the tip is depends on the machine; have the post write "
              "M128, FUNCTION TCPM or PLANE SPATIAL");
}

}  // namespace riffler::nc
