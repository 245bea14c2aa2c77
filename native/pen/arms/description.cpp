#include "pen/arms/description.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/toml.hpp"
#include "riffler/pen/arms/arm.hpp"
#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

namespace {

constexpr double kSquare = 1e-6;     // tolerance of unit lengths and right angles
constexpr double kLongest = 1e4;     // mm: length of a link, far beyond the size of a desk
constexpr double kHeaviest = 100;    // kg: more than a hand can hold
constexpr double kMaxInertia = 1e9;  // kg·mm²
constexpr double kMaxAmperes = 32;   // reports carry mA in 16 bits

std::string in_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

class PenReader : base::TomlReader {
 public:
  PenReader(std::string_view text, const std::string& file) : base::TomlReader(text, file) {}

  std::string summary() { return text(root(), "description"); }

  PenGeometry describe(const std::string& name) {
    allow(root(), {"description", "base", "arms", "grip", "probe", "channels", "converter", "uncertainty", "limits"});
    pen_.name = name;
    pen_.description = summary();
    base(section("base"));
    arms(section("arms"));
    grip(section("grip"));
    probe(section("probe"));
    channels(section("channels"));
    if (root().get("converter")) converter(section("converter"));
    if (root().get("uncertainty")) uncertainty(section("uncertainty"));
    limits(section("limits"));
    check_home();
    return pen_;
  }

 private:
  const toml::table& section(std::string_view key) const { return needed_table(root(), key); }

  double positive(const toml::node& node, std::string_view key, double most) const {
    const double value = number(node, key);
    if (!(value > 0 && value <= most)) fail(node, std::string(key) + " must be positive, at most " + in_digits(most));
    return value;
  }
  double positive(const toml::table& table, std::string_view key, double most = 1e12) const {
    return positive(needed(table, key), key, most);
  }

  Vec3 unit(const toml::table& table, std::string_view key) const {
    const Vec3 v = vector(needed(table, key), key);
    if (std::abs(glm::length(v) - 1) > kSquare) fail(needed(table, key), std::string(key) + " must have the length 1");
    return glm::normalize(v);
  }

  void base(const toml::table& table) {
    allow(table, {"x", "z", "origin"});
    const Vec3 x = unit(table, "x"), z = unit(table, "z");
    if (std::abs(glm::dot(x, z)) > kSquare) fail(needed(table, "z"), "z must be perpendicular to x");
    const Vec3 y = glm::normalize(glm::cross(z, x));
    pen_.turn = Mat3(glm::cross(y, z), y, z);
    pen_.origin = vector(needed(table, "origin"), "origin");
  }

  /// A length per arm: { R = 150, L = 180 }.
  std::array<double, 2> of_both(const toml::table& table, std::string_view key) const {
    const toml::table& both = needed_table(table, key);
    allow(both, {"R", "L"});
    return {positive(both, "R", kLongest), positive(both, "L", kLongest)};
  }

  void arms(const toml::table& table) {
    allow(table, {"shoulder", "upper", "fore"});
    const double shoulder = positive(table, "shoulder", kLongest);
    const auto upper = of_both(table, "upper"), fore = of_both(table, "fore");
    pen_.arms = {ArmLinks{shoulder, upper[0], fore[0]}, ArmLinks{-shoulder, upper[1], fore[1]}};
  }

  void grip(const toml::table& table) {
    allow(table, {"length", "tolerance", "mass", "inertia", "tip"});
    pen_.grip_length = positive(table, "length", kLongest);
    pen_.grip_tolerance = positive(table, "tolerance", kLongest);
    if (!(pen_.grip_tolerance < pen_.grip_length)) fail(needed(table, "tolerance"), "tolerance must be below length");
    pen_.grip_mass = positive(table, "mass", kHeaviest);
    pen_.grip_inertia = positive(table, "inertia", kMaxInertia);
    needed(table, "tip");
    pen_.tip = word(table, "tip", {"R", "L"}, "") == "R" ? Arm::R : Arm::L;
  }

  static int sign_of(std::int64_t value) { return value < 0 ? -1 : 1; }

  void probe(const toml::table& table) {
    allow(table, {"steps", "home", "sign"});
    pen_.probe_steps = static_cast<double>(whole(needed(table, "steps"), "steps", 1, kMaxSteps));
    pen_.probe_home = static_cast<std::int32_t>(whole(needed(table, "home"), "home", -kMaxHome, kMaxHome));
    pen_.probe_sign = sign_of(plus_or_minus(needed(table, "sign")));
  }

  std::int64_t plus_or_minus(const toml::node& node) const {
    const auto* value = node.as_integer();
    if (!value || (value->get() != 1 && value->get() != -1)) fail(node, "sign must be 1 or -1");
    return value->get();
  }

  /// The list of six under `key`.
  const toml::array& six(const toml::table& table, std::string_view key) const {
    const toml::node& node = needed(table, key);
    const toml::array* list = node.as_array();
    if (!list || list->size() != kPenChannels)
      fail(node, std::string(key) + " must be a list of six, one for each of order");
    return *list;
  }

  void channels(const toml::table& table) {
    allow(table, {"order", "lines", "motor_teeth", "joint_teeth", "sign", "home", "low", "high", "torque_constant",
                  "peak_current", "continuous_current", "coulomb", "viscous", "gravity", "inertia", "resistance"});
    order(six(table, "order"));
    const auto each = [&](std::string_view key, auto&& take) {
      const toml::array& list = six(table, key);
      for (std::size_t k = 0; k < kPenChannels; ++k)
        take(pen_.channels[k], list[k], std::string(key) + ", entry " + std::to_string(k + 1));
    };
    const auto teeth = [&](const toml::node& node, const std::string& key) {
      return static_cast<double>(whole(node, key, 1, 10000));
    };
    const auto not_negative = [&](const toml::node& node, const std::string& key) {
      const double value = number(node, key);
      if (value < 0) fail(node, key + " must not be negative");
      return value;
    };
    const auto angle = [&](const toml::node& node, const std::string& key) {
      const double value = number(node, key);
      if (std::abs(value) > 3.2) fail(node, key + " must be an angle in rad, within half a turn");
      return value;
    };
    each("motor_teeth", [&](PenChannel& c, const toml::node& n, const std::string& key) { c.ratio = teeth(n, key); });
    each("joint_teeth",
         [&](PenChannel& c, const toml::node& n, const std::string& key) { c.ratio = teeth(n, key) / c.ratio; });
    // A line of the encoder gives four counts: both edges of two tracks.
    each("lines", [&](PenChannel& c, const toml::node& n, const std::string& key) {
      c.steps = 4 * static_cast<double>(whole(n, key, 1, 1000000)) * c.ratio;
      if (c.steps > static_cast<double>(kMaxSteps))
        fail(n, key + ": more than " + std::to_string(kMaxSteps) + " counts per turn of the joint");
    });
    each("sign", [&](PenChannel& c, const toml::node& n, const std::string&) { c.sign = sign_of(plus_or_minus(n)); });
    each("home", [&](PenChannel& c, const toml::node& n, const std::string& key) {
      c.home = static_cast<std::int32_t>(whole(n, key, -kMaxHome, kMaxHome));
    });
    each("low", [&](PenChannel& c, const toml::node& n, const std::string& key) { c.low = angle(n, key); });
    each("high", [&](PenChannel& c, const toml::node& n, const std::string& key) {
      c.high = angle(n, key);
      if (!(c.low < c.high)) fail(n, key + " must be above low");
    });
    each("torque_constant", [&](PenChannel& c, const toml::node& n, const std::string& key) {
      c.torque_constant = positive(n, key, 1e6);
    });
    each("peak_current", [&](PenChannel& c, const toml::node& n, const std::string& key) {
      c.peak_current = positive(n, key, kMaxAmperes);
    });
    each("continuous_current", [&](PenChannel& c, const toml::node& n, const std::string& key) {
      c.continuous_current = positive(n, key, c.peak_current);
    });
    each("coulomb",
         [&](PenChannel& c, const toml::node& n, const std::string& key) { c.coulomb = not_negative(n, key); });
    each("viscous",
         [&](PenChannel& c, const toml::node& n, const std::string& key) { c.viscous = not_negative(n, key); });
    each("gravity", [&](PenChannel& c, const toml::node& n, const std::string& key) {
      c.gravity = not_negative(n, key);
      if (c.joint == 0 && c.gravity != 0) fail(n, key + " must be 0: joint 1 turns about the vertical axis");
    });
    each("inertia", [&](PenChannel& c, const toml::node& n, const std::string& key) {
      c.inertia = positive(n, key, kMaxInertia);
    });
    each("resistance",
         [&](PenChannel& c, const toml::node& n, const std::string& key) { c.resistance = positive(n, key, 1e6); });
  }

  void order(const toml::array& list) {
    std::array<bool, kPenChannels> taken{};
    for (std::size_t k = 0; k < kPenChannels; ++k) {
      const auto* text = list[k].as_string();
      const std::string name = text ? text->get() : "";
      if (name.size() != 2 || (name[0] != 'R' && name[0] != 'L') || name[1] < '1' || name[1] > '3')
        fail(list[k], "order must be of R1 R2 R3 L1 L2 L3");
      PenChannel& channel = pen_.channels[k];
      channel.arm = name[0] == 'R' ? Arm::R : Arm::L, channel.joint = name[1] - '1';
      bool& here = taken[3 * index(channel.arm) + static_cast<std::size_t>(channel.joint)];
      if (here) fail(list[k], "order has " + name + " twice");
      here = true;
    }
  }

  void uncertainty(const toml::table& table) {
    allow(table, {"torque_constant", "coulomb", "viscous", "gravity"});
    PenUncertainty out;
    const auto each = [&](std::string_view key, std::array<double, kPenChannels>& values) {
      const toml::array& list = six(table, key);
      for (std::size_t k = 0; k < kPenChannels; ++k) {
        const std::string entry = std::string(key) + ", entry " + std::to_string(k + 1);
        values[k] = number(list[k], entry);
        if (values[k] < 0) fail(list[k], entry + " must not be negative");
      }
    };
    each("torque_constant", out.torque_constant), each("coulomb", out.coulomb);
    each("viscous", out.viscous), each("gravity", out.gravity);
    pen_.uncertainty = out;
  }

  void converter(const toml::table& table) {
    allow(table, {"bits", "slope", "offset"});
    Converter out;
    out.bits = static_cast<int>(whole(needed(table, "bits"), "bits", 2, 16));
    const toml::array &slopes = six(table, "slope"), &offsets = six(table, "offset");
    for (std::size_t k = 0; k < kPenChannels; ++k) {
      const std::string entry = ", entry " + std::to_string(k + 1);
      out.slope[k] = number(slopes[k], "slope" + entry), out.offset[k] = number(offsets[k], "offset" + entry);
      if (out.slope[k] == 0) fail(slopes[k], "slope" + entry + " must not be 0");
      const double most = std::abs(out.slope[k]) * pen_.channels[k].peak_torque() + std::abs(out.offset[k]);
      if (most > out.highest())
        fail(slopes[k], "slope" + entry + ": the motor's peak torque, " + in_digits(pen_.channels[k].peak_torque()) +
                            " N*mm, would be step " + in_digits(most) + ", and the converter ends at " +
                            std::to_string(out.highest()));
    }
    pen_.converter = out;
  }

  void limits(const toml::table& table) {
    allow(table, {"elbow", "lower", "upper", "force", "torque", "speed", "turn_rate", "friction_speed"});
    const toml::node& elbow = needed(table, "elbow");
    const Vec2 range = growing_pair(elbow, "elbow");
    // At ±π/2 an arm is straight or folded, and beyond it the solution for its angles is no longer unique.
    if (!(range.x > -1.57 && range.y < 1.57)) fail(elbow, "elbow must lie within -1.57 and 1.57 rad");
    pen_.elbow_low = range.x, pen_.elbow_high = range.y;
    pen_.workspace = {vector(needed(table, "lower"), "lower"), vector(needed(table, "upper"), "upper")};
    if (!glm::all(glm::lessThan(pen_.workspace.lower, pen_.workspace.upper)))
      fail(needed(table, "upper"), "upper must be above lower");
    pen_.force = positive(table, "force"), pen_.torque = positive(table, "torque");
    pen_.speed = positive(table, "speed"), pen_.turn_rate = positive(table, "turn_rate");
    pen_.friction_speed = positive(table, "friction_speed");
  }

  /// A pen that contradicts itself in its home posture would be wrong everywhere.
  void check_home() const {
    const toml::node& home = needed(section("channels"), "home");
    const PenKinematics kinematics(pen_);
    const PenPosture posture = kinematics.posture(kinematics.home_angles());
    const JointAngles& angles = posture.angles;
    for (std::size_t k = 0; k < kPenChannels; ++k) {
      const PenChannel& c = pen_.channels[k];
      const double angle = angles[index(c.arm)][c.joint];
      if (angle < c.low || angle > c.high)
        fail(home, "home, entry " + std::to_string(k + 1) + ": " + in_digits(angle) + " rad, and its limits are " +
                       in_digits(c.low) + " to " + in_digits(c.high));
    }
    for (const Vec3& arm : angles)
      if (arm.y - arm.z < pen_.elbow_low || arm.y - arm.z > pen_.elbow_high)
        fail(home, "home: joint 2 minus joint 3 is " + in_digits(arm.y - arm.z) + " rad, and the elbow's limits are " +
                       in_digits(pen_.elbow_low) + " to " + in_digits(pen_.elbow_high));
    if (std::abs(posture.length - pen_.grip_length) > pen_.grip_tolerance)
      fail(home, "home: the arms' ends are " + in_digits(posture.length) + " mm apart there, and the grip is " +
                     in_digits(pen_.grip_length) + " mm long (tolerance " + in_digits(pen_.grip_tolerance) +
                     "): arms, home presets and grip do not fit each other");
    const Vec3 middle = 0.5 * (posture.arms[0].end + posture.arms[1].end);
    const Box3& box = pen_.workspace;
    if (!glm::all(glm::lessThanEqual(box.lower, middle)) || !glm::all(glm::lessThanEqual(middle, box.upper)))
      fail(needed(section("limits"), "lower"), "lower, upper: the grip's middle at home, " + in_digits(middle.x) + " " +
                                                   in_digits(middle.y) + " " + in_digits(middle.z) + ", is outside");
  }

  static constexpr std::int64_t kMaxSteps = 1 << 24, kMaxHome = 1 << 30;
  PenGeometry pen_;
};

}  // namespace

PenGeometry describe_pen(std::string_view toml, const std::string& file, const std::string& name) {
  return PenReader(toml, file).describe(name);
}

std::string pen_summary(std::string_view toml, const std::string& file) {
  return PenReader(toml, file).summary();
}

}  // namespace riffler::pen
