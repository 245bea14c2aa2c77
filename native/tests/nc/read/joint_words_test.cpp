// Programs in which X Y Z are where the linear axes stand: LinuxCNC's tables without its kinematics.
#include <gtest/gtest.h>

#include <cmath>

#include "riffler/base/error.hpp"
#include "riffler/nc/cutter_path.hpp"
#include "riffler/nc/read/reader.hpp"
#include "riffler/nc/write/writer.hpp"
#include "support/nc_blocks.hpp"

namespace riffler::nc::joint_words_test {
namespace {

constexpr double kDegree = 3.141592653589793 / 180;
const Options kTable{{"rot_point", std::vector<double>{12, -7, 30}}, {"offset", std::vector<double>{0, 4, -25}}};

using test::NcBlockEnd;

double word(const NcBlockEnd& a, const NcBlockEnd& b, char letter, double s) {
  const auto of = [&](const NcBlockEnd& e) { return e.at.contains(letter) ? e.at.at(letter) : 0.0; };
  return of(a) + s * (of(b) - of(a));
}

/// The pose at share `s` of a block: all axes move evenly, then the part is turned back by A and C, as
/// test::axis_of does it with whole matrices; LinuxCNC's tables turn in the opposite direction.
Pose xyzac_pose(const NcBlockEnd& a, const NcBlockEnd& b, double s) {
  const Vec3 centre(12, -7, 30), tilt = centre + Vec3(0, 4, -25);
  const double alpha = word(a, b, 'A', s) * kDegree, gamma = word(a, b, 'C', s) * kDegree;
  const Mat3 rx(Vec3(1, 0, 0), Vec3(0, std::cos(alpha), std::sin(alpha)), Vec3(0, -std::sin(alpha), std::cos(alpha)));
  const Mat3 rz(Vec3(std::cos(gamma), std::sin(gamma), 0), Vec3(-std::sin(gamma), std::cos(gamma), 0), Vec3(0, 0, 1));
  const Vec3 joints(word(a, b, 'X', s), word(a, b, 'Y', s), word(a, b, 'Z', s));
  const Vec3 on_table = glm::transpose(rx) * (joints - tilt) + tilt;
  return {glm::transpose(rz) * (on_table - centre) + centre, glm::transpose(rz) * (glm::transpose(rx) * Vec3(0, 0, 1))};
}

Program swaying(int rows) {
  CutterPath path{{}, {600}, 9000, 1};
  for (int i = 0; i < rows; ++i) {
    const double t = static_cast<double>(i) / rows;
    path.poses.push_back(
        {{80 * t, 20 * std::sin(9 * t), -5 * t}, glm::normalize(Vec3(std::sin(7 * t), std::sin(5 * t) - 0.3, 1))});
  }
  return program_from_paths(std::vector{path}, {});
}

WriteOptions to_xyzac(Options more = {}) {
  WriteOptions out;
  out.post = "linuxcnc-xyzac", out.options = kTable;
  out.options.merge(more);
  return out;
}

TEST(JointWords, KeepTheTipOnItsLineBetweenBlocks) {
  const Program p = swaying(30);
  for (const double tolerance : {0.1, 0.01, 0.001}) {
    WriteOptions options = to_xyzac({{"safe_start", false}});
    options.tolerance = tolerance;
    const auto blocks = test::block_ends(to_nc(p, options));
    std::size_t row = 0;
    double worst = 0;
    for (std::size_t k = 1; k < blocks.size(); ++k) {
      // Which move of the program this block is part of: its ends are on it.
      while (row + 1 < p.size() &&
             glm::length(p.poses()[row].tip - xyzac_pose(blocks[k - 1], blocks[k - 1], 0).tip) < 1e-4)
        ++row;
      const Motion move(p.poses()[row > 0 ? row - 1 : 0], p.poses()[row]);
      const Vec3 way = move.to().tip - move.from().tip;
      for (int i = 0; i <= 20; ++i) {
        const Vec3 tip = xyzac_pose(blocks[k - 1], blocks[k], i / 20.0).tip;
        const double length2 = glm::dot(way, way);
        const double t = length2 > 0 ? std::clamp(glm::dot(tip - move.from().tip, way) / length2, 0.0, 1.0) : 0;
        worst = std::max(worst, glm::length(tip - move.tip(t)));
      }
    }
    EXPECT_LE(worst, tolerance + 2e-5) << tolerance;
    EXPECT_GT(worst, tolerance / 100) << tolerance;
    EXPECT_EQ(row, p.size() - 1);
  }
}

TEST(JointWords, ThatTurnStateTheirTime) {
  const Program p = swaying(30);
  const auto blocks = test::block_ends(to_nc(p, to_xyzac()));
  int inverse = 0;
  for (std::size_t k = 1; k < blocks.size(); ++k) {
    const NcBlockEnd &a = blocks[k - 1], &b = blocks[k];
    if (b.rapid) continue;
    const bool turns = word(a, a, 'A', 0) != word(b, b, 'A', 0) || word(a, a, 'C', 0) != word(b, b, 'C', 0);
    ASSERT_EQ(b.inverse, turns) << k;
    if (!turns) continue;
    ++inverse;
    ASSERT_TRUE(b.fed) << "under G93 every block has its own F";
    const double way = glm::length(xyzac_pose(b, b, 0).tip - xyzac_pose(a, a, 0).tip);
    const double degrees =
        std::max(std::abs(word(b, b, 'A', 0) - word(a, a, 'A', 0)), std::abs(word(b, b, 'C', 0) - word(a, a, 'C', 0)));
    EXPECT_NEAR(1 / b.at.at('F'), std::max(way / 600, degrees / 3600), 2e-6 + 1e-4 / b.at.at('F')) << k;
  }
  EXPECT_GT(inverse, 20);
}

TEST(JointWords, TurnNoFasterThanTheFeedAllows) {
  const auto blocks = test::block_ends(to_nc(swaying(30), to_xyzac({{"max_rotary", 90.0}})));
  double fastest = 0;
  for (std::size_t k = 1; k < blocks.size(); ++k) {
    if (!blocks[k].inverse || blocks[k].rapid) continue;
    for (const char letter : {'A', 'C'})
      fastest = std::max(
          fastest, std::abs(word(blocks[k], blocks[k], letter, 0) - word(blocks[k - 1], blocks[k - 1], letter, 0)) *
                       blocks[k].at.at('F'));
  }
  EXPECT_LE(fastest, 90 * 1.0001);
  EXPECT_GT(fastest, 85);
}

TEST(JointWords, ReadBackAsTheSamePosesAndFeeds) {
  const Program p = swaying(25);
  for (const char* post : {"linuxcnc-xyzac", "linuxcnc-xyzbc"})
    for (const bool tcp : {false, true})
      for (const char* direction : {"linuxcnc", "iso"}) {
        WriteOptions write = to_xyzac({{"tcp", tcp}, {"direction", std::string(direction)}, {"max_rotary", 1e7}});
        write.post = post;
        ReadOptions read{post, write.options};
        const Program back = parse_nc(to_nc(p, write), "p.ngc", read);
        std::size_t row = 0;
        for (std::size_t k = 0; k < back.size() && row < p.size(); ++k) {
          const Pose &is = back.poses()[k], &wanted = p.poses()[row];
          if (glm::length(is.tip - wanted.tip) > 3e-5 || test::angle(is.axis, wanted.axis) > 1e-7) continue;
          if (!p.rapid()[row]) {
            EXPECT_NEAR(back.feed()[k], p.feed()[row], 0.01 * p.feed()[row]);
          }
          EXPECT_EQ(back.rapid()[k], p.rapid()[row]);
          ++row;
        }
        EXPECT_EQ(row, p.size()) << post << (tcp ? ", tcp, " : ", ") << direction;
      }
}

TEST(JointWords, UnderUnitsPerMinuteReadBackWithTheFeedOfTheTip) {
  const Program p = swaying(25);
  const WriteOptions write = to_xyzac({{"feed", std::string("per-minute")}, {"max_rotary", 1e7}});
  const std::string text = to_nc(p, write);
  EXPECT_EQ(text.find("G93"), text.npos);
  const Program back = parse_nc(text, "p.ngc", {"linuxcnc-xyzac", write.options});
  double minutes = 0, wanted = 0;
  for (std::size_t k = 1; k < back.size(); ++k)
    if (!back.rapid()[k] && back.feed()[k] > 0)
      minutes += glm::length(back.poses()[k].tip - back.poses()[k - 1].tip) / back.feed()[k];
  for (std::size_t k = 1; k < p.size(); ++k)
    if (!p.rapid()[k]) wanted += glm::length(p.poses()[k].tip - p.poses()[k - 1].tip) / p.feed()[k];
  EXPECT_NEAR(minutes, wanted, 1e-3 * wanted);
}

TEST(Header, KeepsCodeFromBeingReadForAnotherMachine) {
  const auto error = [](const std::string& text, const char* machine, Options options = {}) -> std::string {
    try {
      parse_nc(text, "p.ngc", {machine, std::move(options)});
    } catch (const FormatError& e) {
      return e.what();
    }
    return "";
  };
  const std::string joints = to_nc(swaying(3), to_xyzac()), tip = to_nc(swaying(3), to_xyzac({{"tcp", true}}));
  EXPECT_EQ(error(joints, "linuxcnc-xyzac", kTable), "");
  EXPECT_EQ(error(joints, "tcp").substr(0, 104),
            "p.ngc, line 1: written for machine linuxcnc-xyzac, not tcp: read it with machine linuxcnc-xyzac, or with");
  EXPECT_NE(
      error(joints, "linuxcnc-xyzac", {{"tcp", true}}).find("line 2: X Y Z are where the axes stand here: read it"),
      std::string::npos);
  EXPECT_NE(error(tip, "linuxcnc-xyzac", kTable).find("read it with options {'tcp': True}"), std::string::npos);
  EXPECT_EQ(error(joints, "tcp", {{"header", std::string("ignore")}}), "");

  CutterPath upright{{{{1, 2, 3}, {0, 0, 1}}, {{4, 5, 6}, {0, 0, 1}}}, {500}, 0, 1};
  WriteOptions three;
  three.post = "3-axis";
  const std::string text = to_nc(program_from_paths(std::vector{upright}, {}), three);
  EXPECT_EQ(error(text, "tcp"), "") << "upright tools are upright anywhere";
  EXPECT_NE(error(text, "linuxcnc-xyzac", kTable), "");
  EXPECT_EQ(error("(some other CAM)\nG0 X1\n", "tcp"), "");
}

TEST(JointWords, AreReadUpToTheLineThatLeavesALimit) {
  const std::string text = to_nc(swaying(25), to_xyzac());
  Options narrow = kTable;
  narrow["limits_a"] = std::vector<double>{-20, 20};
  try {
    parse_nc(text, "p.ngc", {"linuxcnc-xyzac", narrow});
    FAIL();
  } catch (const FormatError& e) {
    EXPECT_NE(std::string(e.what()).find("beyond the limits of machine linuxcnc-xyzac, -20 to 20"), std::string::npos);
  }
}

TEST(JointWords, TheFirstRapidIsOneRowAtItsEnd) {
  const Program p = swaying(5);
  const std::string text = to_nc(p, to_xyzac({{"safe_start", false}}));
  const Program back = parse_nc(text, "p.ngc", {"linuxcnc-xyzac", kTable});
  EXPECT_LT(glm::length(back.poses()[0].tip - p.poses()[0].tip), 1e-4) << "one row, where it ends";
}

TEST(JointWords, NeedThePivotOfATable) {
  for (const char* name : {"linuxcnc-xyzac", "linuxcnc-xyzbc", "head-table"}) {
    Options options;
    if (name == std::string("head-table")) options = {{"tcp", false}, {"pivot_length", 200.0}};
    WriteOptions how;
    how.post = name, how.options = options;
    try {
      to_nc(swaying(2), how);
      ADD_FAILURE() << name;
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find("option rot_point must be given: [x, y, z] in part coordinates"),
                std::string::npos)
          << e.what();
    }
    how.options["rot_point"] = std::vector<double>{0, 0, -40};
    EXPECT_NO_THROW(to_nc(swaying(2), how)) << name;
    // Where the control keeps the tip the pivot is its own.
    how.options = {{"tcp", true}};
    EXPECT_NO_THROW(to_nc(swaying(2), how)) << name;
  }
}

TEST(JointWords, AreDescribedInTheHeader) {
  const std::string joints = to_nc(swaying(2), to_xyzac()), tip = to_nc(swaying(2), to_xyzac({{"tcp", true}}));
  EXPECT_NE(joints.find("kinematics off [M429]"), std::string::npos);
  EXPECT_NE(tip.find("kinematics on [M428]"), std::string::npos);
  EXPECT_EQ(tip.find("G93"), std::string::npos);
}

TEST(JointWords, RefuseWrongOptions) {
  const auto message = [](Options options) {
    try {
      to_nc(swaying(2), to_xyzac(std::move(options)));
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({{"direction", std::string("left")}}),
            "post linuxcnc-xyzac: option direction must be one of linuxcnc, iso");
  EXPECT_EQ(message({{"tool_offset", true}}), "post linuxcnc-xyzac: option tool_offset must be a finite number");
  EXPECT_EQ(message({{"tcp", 1.0}}), "post linuxcnc-xyzac: option tcp must be true or false");
  EXPECT_EQ(message({{"max_rotary", -1.0}}),
            "post linuxcnc-xyzac: option max_rotary must be a positive, finite number");
}

TEST(TipWords, ATurnInPlaceIsNotFasterThanItsAxis) {
  CutterPath path{{}, {2000}, 9000, 1};
  for (int k = 0; k <= 20; ++k)
    path.poses.push_back({{1, 2, 3}, glm::normalize(Vec3(std::sin(0.1 * k), 0.3, std::cos(0.1 * k)))});
  const Program p = program_from_paths(std::vector{path}, {});
  WriteOptions options;
  options.options = {{"rate_c", 300.0}, {"rate_a", 500.0}};
  const auto blocks = test::block_ends(to_nc(p, options));
  int turns = 0;
  for (std::size_t k = 1; k < blocks.size(); ++k) {
    if (blocks[k].rapid || word(blocks[k - 1], blocks[k], 'X', 0) != word(blocks[k - 1], blocks[k], 'X', 1)) continue;
    const double a = word(blocks[k - 1], blocks[k], 'A', 1) - word(blocks[k - 1], blocks[k], 'A', 0);
    const double c = word(blocks[k - 1], blocks[k], 'C', 1) - word(blocks[k - 1], blocks[k], 'C', 0);
    const double minutes = std::hypot(a, c) / blocks[k].at.at('F');
    EXPECT_GE(minutes * 300 * 1.0001, std::abs(c));
    EXPECT_GE(minutes * 500 * 1.0001, std::abs(a));
    turns += c != 0;
  }
  EXPECT_GT(turns, 15);
}

TEST(JointWords, TheMotionOfANewToolIsNotTimed) {
  // Rows of feed throughout, the tool changed between two of them: where the machine was for it is not known.
  Program p;
  for (int k = 0; k < 10; ++k)
    p.append({{{1e-3 * k, 0, 0}, glm::normalize(Vec3(0.1 * k, 0.2, 1))}, 600, 8000, 1 + k / 5});
  const std::string text = to_nc(p, to_xyzac());
  const std::size_t change = text.find("T2 M6"), next = text.find("\nG94", change), move = text.find("G1", change);
  ASSERT_NE(change, text.npos);
  EXPECT_LT(next, move);
  EXPECT_EQ(text.substr(change, move - change).find("G93"), text.npos);
  const std::string line = text.substr(move, text.find('\n', move) - move);
  EXPECT_NE(line.find(" F600"), line.npos) << line;
}

}  // namespace
}  // namespace riffler::nc::joint_words_test
