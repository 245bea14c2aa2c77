// Pens described in files: what they say, what is wrong with them, and where they are found.
#include "pen/arms/description.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <stdexcept>

#include "base/io.hpp"
#include "pen/arms/pens.hpp"
#include "pen/arms/shipped_pens.hpp"
#include "riffler/base/error.hpp"
#include "riffler/pen/arms/kinematics.hpp"
#include "support/damaged.hpp"

namespace riffler::pen::pen_description_test {
namespace {

std::string shipped() {
  return std::string(shipped_pens()[0].toml);
}

std::string error(const std::string& toml) {
  try {
    describe_pen(toml, "pen.toml", "pen");
  } catch (const FormatError& e) {
    return e.what();
  }
  return "";
}

/// The shipped pen with one text for another, and the message's "pen.toml, line N: " with the right N.
std::string with(const std::string& text, const std::string& other) {
  std::string out = shipped();
  const std::size_t at = out.find(text);
  EXPECT_NE(at, out.npos) << text;
  return out.replace(at, text.size(), other);
}

std::string line_of(const std::string& toml, const std::string& text) {
  const std::size_t at = toml.find(text);
  EXPECT_NE(at, toml.npos) << text;
  return "pen.toml, line " + std::to_string(1 + std::count(toml.begin(), toml.begin() + static_cast<long>(at), '\n')) +
         ": ";
}

/// The message for `text` replaced by `other`, which stands in the line that it names.
void expect(const std::string& text, const std::string& other, const std::string& message) {
  const std::string toml = with(text, other);
  EXPECT_EQ(error(toml), line_of(toml, other) + message);
}

/// As above, but the message is of the table under `place`, or of another key.
void expect_at(const std::string& place, const std::string& text, const std::string& other,
               const std::string& message) {
  const std::string toml = with(text, other);
  EXPECT_EQ(error(toml), line_of(toml, place) + message);
}

TEST(PenGeometry, ShippedPenIsTheSources) {
  const PenGeometry pen = load_pen("riffler");
  EXPECT_EQ(pen.arms[0].shoulder, 80);
  EXPECT_EQ(pen.arms[1].shoulder, -80);
  EXPECT_EQ(pen.arms[0].upper, 150);
  EXPECT_EQ(pen.arms[1].upper, 180);
  EXPECT_EQ(pen.arms[0].fore, 180);
  EXPECT_EQ(pen.grip_length, 30);
  EXPECT_EQ(pen.channels[0].steps, 48000);
  EXPECT_EQ(pen.channels[2].steps, 70000);
  EXPECT_EQ(pen.channels[2].joint, 0);
  EXPECT_EQ(pen.channels[2].home, -5133);
  EXPECT_EQ(pen.channels[5].arm, Arm::L);
  EXPECT_EQ(pen.converter->lowest(), -2048);
  EXPECT_EQ(pen.converter->highest(), 2047);
  EXPECT_EQ(pen.name, "riffler");
  EXPECT_EQ(error(shipped()), "");
}

TEST(PenGeometry, TurnIsARotationWhereAxesAreNearlySquare) {
  const PenGeometry pen = describe_pen(with("x = [1.0, 0.0, 0.0]", "x = [0.6, 0.8, 5e-7]"), "pen.toml", "pen");
  EXPECT_NEAR(glm::determinant(pen.turn), 1, 1e-15);
  EXPECT_LT(glm::distance(glm::transpose(pen.turn) * pen.turn * Vec3(1, 2, 3), Vec3(1, 2, 3)), 1e-14);
}

TEST(PenGeometry, NamesAMissingKey) {
  EXPECT_EQ(error("x = 1\n"), "pen.toml, line 1: unknown key x");
  EXPECT_EQ(error(""), "pen.toml, line 1: description is missing");
  std::string some = "description = \"x\"\n";
  for (const char* section : {"base", "arms", "grip", "probe", "channels", "limits"}) {
    EXPECT_EQ(error(some), "pen.toml, line 1: " + std::string(section) + " is missing");
    const std::string toml = shipped();
    const std::size_t from = toml.find("[" + std::string(section) + "]"), to = toml.find("\n[", from);
    some += toml.substr(from, to == toml.npos ? to : to + 1 - from);
  }
  expect_at("[base]", "z = [0.0, 0.0, 1.0]", "", "z is missing");
  expect_at("[arms]", "shoulder = 80.0", "", "shoulder is missing");
  expect_at("{ L = 180.0 }     #", "fore = { R = 180.0, L = 180.0 }", "fore = { L = 180.0 }", "R is missing");
  expect_at("[grip]", "length = 30.0", "", "length is missing");
  expect_at("[grip]", "tip = \"L\"", "", "tip is missing");
  expect_at("[probe]", "steps = 800", "", "steps is missing");
  expect_at("[channels]", "order = [\"R2\", \"R3\", \"R1\", \"L2\", \"L3\", \"L1\"]", "", "order is missing");
  expect_at("[channels]", "home = [0, 0, -5133, 0, 0, 5133]", "", "home is missing");
  expect_at("[converter]", "bits = 12", "", "bits is missing");
  expect_at("[limits]", "elbow = [-1.2, 1.2]", "", "elbow is missing");
  expect_at("[limits]", "force = 6.0", "", "force is missing");
}

TEST(PenGeometry, NamesTheExpectedType) {
  expect("shoulder = 80.0", "shoulder = \"80\"", "shoulder must be a finite number");
  expect("upper = { R = 150.0, L = 180.0 }", "upper = 150.0", "upper must be a table");
  expect("tip = \"L\"", "tip = 1", "tip must be a text");
  expect("tip = \"L\"", "tip = \"left\"", "tip must be one of R, L");
  expect("steps = 800", "steps = 800.5", "steps must be a whole number from 1 to 16777216");
  expect("x = [1.0, 0.0, 0.0]", "x = [1.0, 0.0]", "x must be three finite numbers");
  expect("joint_teeth = [72, 72, 105, 72, 72, 105]", "joint_teeth = [72, 72, 105]",
         "joint_teeth must be a list of six, one for each of order");
  expect("joint_teeth = [72, 72, 105, 72, 72, 105]", "joint_teeth = 72",
         "joint_teeth must be a list of six, one for each of order");
  expect("joint_teeth = [72, 72, 105, 72, 72, 105]", "joint_teeth = [72, 72, 105, 72.5, 72, 105]",
         "joint_teeth, entry 4 must be a whole number from 1 to 10000");
  expect("elbow = [-1.2, 1.2]", "elbow = 1.2", "elbow must be two numbers");
  expect("description = \"Pen", "description = [] #", "description must be a text");
}

TEST(PenGeometry, RefusesImpossibleValues) {
  expect("shoulder = 80.0", "shoulder = -80.0", "shoulder must be positive, at most 10000");
  expect("shoulder = 80.0", "shoulder = 8e4", "shoulder must be positive, at most 10000");
  expect("upper = { R = 150.0", "upper = { R = -150.0", "R must be positive, at most 10000");
  expect("shoulder = 80.0", "shoulder = nan", "shoulder must be a finite number");
  expect("length = 30.0", "length = inf", "length must be a finite number");
  expect("length = 30.0", "length = 0", "length must be positive, at most 10000");
  expect("tolerance = 0.25", "tolerance = 31", "tolerance must be below length");
  expect("x = [1.0, 0.0, 0.0]", "x = [2.0, 0.0, 0.0]", "x must have the length 1");
  expect("z = [0.0, 0.0, 1.0]", "z = [0.6, 0.0, 0.8]", "z must be perpendicular to x");
  expect("sign = 1  ", "sign = 2  ", "sign must be 1 or -1");
  expect("\"R2\", \"R3\"", "\"R2\", \"R4\"", "order must be of R1 R2 R3 L1 L2 L3");
  expect("\"R2\", \"R3\"", "\"R2\", \"R2\"", "order has R2 twice");
  expect("high = [1.0, 1.0, 0.6, 1.0, 1.0, 1.2]", "high = [1.0, -1.0, 0.6, 1.0, 1.0, 1.2]",
         "high, entry 2 must be above low");
  expect("low = [-0.7,", "low = [-40,", "low, entry 1 must be an angle in rad, within half a turn");
  expect("torque_constant = [30.0,", "torque_constant = [0.0,",
         "torque_constant, entry 1 must be positive, at most 1e+06");
  expect("peak_current = [3.0,", "peak_current = [40.0,", "peak_current, entry 1 must be positive, at most 32");
  expect("continuous_current = [1.0,", "continuous_current = [4.0,",
         "continuous_current, entry 1 must be positive, at most 3");
  expect("coulomb = [1.5,", "coulomb = [-1.5,", "coulomb, entry 1 must not be negative");
  expect("gravity = [60.0, 30.0, 0.0,", "gravity = [60.0, 30.0, 5.0,",
         "gravity, entry 3 must be 0: joint 1 turns about the vertical axis");
  expect("inertia = [260.0,", "inertia = [0.0,", "inertia, entry 1 must be positive, at most 1e+09");
  expect("resistance = [2.0,", "resistance = [-2.0,", "resistance, entry 1 must be positive, at most 1e+06");
  expect("mass = 0.02", "mass = 200.0", "mass must be positive, at most 100");
  expect("inertia = 3.0", "inertia = nan", "inertia must be a finite number");
  expect("bits = 12", "bits = 24", "bits must be a whole number from 2 to 16");
  expect("slope = [22.0,", "slope = [0,", "slope, entry 1 must not be 0");
  expect("slope = [22.0,", "slope = [-23.0,",
         "slope, entry 1: the motor's peak torque, 90 N*mm, would be step 2070, and the converter ends at 2047");
  expect("lines = [2000,", "lines = [1000000,", "lines, entry 1: more than 16777216 counts per turn of the joint");
  expect("elbow = [-1.2, 1.2]", "elbow = [1.2, -1.2]", "elbow must be in increasing order");
  expect("elbow = [-1.2, 1.2]", "elbow = [-1.2, 1.6]", "elbow must lie within -1.57 and 1.57 rad");
  expect("upper = [260.0, 110.0, -80.0]", "upper = [60.0, 110.0, -80.0]", "upper must be above lower");
  expect("force = 6.0", "force = 0.0", "force must be positive, at most 1e+12");
  expect("speed = 1000.0", "speeds = 3\nspeed = 1000.0", "unknown key speeds");
  expect("length = 30.0", "lenght = 30.0", "unknown key lenght");
}

TEST(PenGeometry, RefusesAPenThatContradictsItselfAtHome) {
  const std::string home = "home = [0, 0, -5133, 0, 0, 5133]";
  expect_at("home = [0,", "length = 30.0", "length = 31.0",
            "home: the arms' ends are 30.0001 mm apart there, and the grip is 31 mm long (tolerance 0.25): arms, home "
            "presets and grip do not fit each other");
  expect_at("home = [0,", "shoulder = 80.0", "shoulder = 90.0",
            "home: the arms' ends are 36.0228 mm apart there, and the grip is 30 mm long (tolerance 0.25): arms, home "
            "presets and grip do not fit each other");
  expect(home, "home = [0, 0, 5133, 0, 0, -5133]",
         "home: the arms' ends are 321.462 mm apart there, and the grip is 30 mm long (tolerance 0.25): arms, home "
         "presets and grip do not fit each other");
  expect(home, "home = [9000, 0, -5133, 9000, 0, 5133]", "home, entry 1: 1.1781 rad, and its limits are -0.7 to 1");
  expect_at("home = [0,", "elbow = [-1.2, 1.2]", "elbow = [0.1, 1.2]",
            "home: joint 2 minus joint 3 is 0 rad, and the elbow's limits are 0.1 to 1.2");
  expect_at("lower = [200.0", "lower = [100.0, -110.0, -240.0]", "lower = [200.0, -110.0, -240.0]",
            "lower, upper: the grip's middle at home, 161.231 0 -165, is outside");
}

TEST(PenGeometry, APenNeedsNoConverter) {
  std::string toml = shipped();
  const std::size_t from = toml.find("[converter]"), to = toml.find("[limits]");
  EXPECT_FALSE(describe_pen(toml.erase(from, to - from), "pen.toml", "pen").converter);
}

TEST(PenGeometry, AnyDamageIsAPenOrAnError) {
  std::mt19937 random(4);
  const std::string good = shipped();
  int pens = 0;
  for (int round = 0; round < 4000; ++round) {
    const std::string text = test::damaged(good, round, random);
    try {
      const PenKinematics pen(describe_pen(text, "pen.toml", "pen"));
      EXPECT_TRUE(geom::finite(pen.posture(pen.home_angles()).pose.axis));
      ++pens;
    } catch (const FormatError&) {
    }
  }
  EXPECT_GT(pens, 100) << "comments are most of the file";
}

TEST(Pens, AreFoundByNameAndByPath) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "riffler-pens-test";
  std::filesystem::create_directories(folder);
  base::write_file(folder / "mine.toml", with("length = 30.0", "length = 30.1"));
  base::write_file(folder / "broken.toml", std::string_view("description = 3"));
  base::write_file(folder / "riffler.toml", std::string_view("description = \"hidden\""));
  setenv("RIFFLER_PENS", folder.c_str(), 1);
  std::string list;
  for (const base::DescriptionEntry& entry : pens()) list += entry.name + ": " + entry.description + "\n";
  EXPECT_NE(list.find("riffler: Pen with two arms"), list.npos) << list;
  EXPECT_NE(list.find("mine: Pen with two arms"), list.npos) << list;
  EXPECT_NE(list.find("broken: cannot be read: broken.toml, line 1: description must be a text"), list.npos) << list;
  EXPECT_NE(list.find("riffler.toml: not used: a pen of this name comes with Riffler"), list.npos) << list;
  EXPECT_EQ(load_pen("mine").grip_length, 30.1);
  EXPECT_EQ(load_pen((folder / "mine.toml").string()).name, "mine");
  try {
    load_pen("yours");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(),
                 "unknown pen 'yours'; known: riffler, broken, mine, riffler, or the path of a .toml file that "
                 "describes your pen");
  }
  EXPECT_THROW(load_pen("nowhere.toml"), FormatError);
  unsetenv("RIFFLER_PENS");
  std::filesystem::remove_all(folder);
}

TEST(PenDescription, AnIdentifiedPenHasUncertainties) {
  EXPECT_FALSE(describe_pen(shipped(), "pen.toml", "pen").uncertainty);
  const std::string table =
      "[uncertainty]\ntorque_constant = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]\ncoulomb = [1, 1, 1, 1, 1, 1]\n"
      "viscous = [0, 0, 0, 0, 0, 1e-4]\ngravity = [1, 2, 0, 3, 4, 0]\n";
  const PenGeometry pen = describe_pen(shipped() + table, "pen.toml", "pen");
  ASSERT_TRUE(pen.uncertainty);
  EXPECT_EQ(pen.uncertainty->torque_constant[5], 0.6);
  EXPECT_EQ(pen.uncertainty->viscous[5], 1e-4);
  EXPECT_EQ(pen.uncertainty->gravity[3], 3);
  const auto end = [](const std::string& text) { return text.substr(std::min(text.size(), text.find(": ") + 2)); };
  EXPECT_EQ(end(error(shipped() + table + "mass = 1\n")).substr(0, 7), "unknown");
  EXPECT_EQ(end(error(shipped() + "[uncertainty]\ntorque_constant = [-1, 0, 0, 0, 0, 0]\n")),
            "torque_constant, entry 1 must not be negative");
  EXPECT_EQ(end(error(shipped() + "[uncertainty]\ntorque_constant = [1]\n")),
            "torque_constant must be a list of six, one for each of order");
}

}  // namespace
}  // namespace riffler::pen::pen_description_test
