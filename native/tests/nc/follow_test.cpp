// The motion between rows is the machine's: rotary axes turn evenly, off the great circle.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "geom/math.hpp"
#include "nc/follow.hpp"
#include "riffler/nc/edit.hpp"
#include "riffler/nc/program_file.hpp"
#include "riffler/nc/write/writer.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::follow_test {
namespace {

using test::read_nc_text;

/// The tool's axis, seen from the part, with a head that tilts by B about y over a table that turns by C.
Vec3 axis_at(double b, double c) {
  const double s = std::sin(b * kDegree);
  return {s * std::cos(c * kDegree), -s * std::sin(c * kDegree), std::cos(b * kDegree)};
}

/// The largest distance of the program's axis from where even rotation takes it, C from 0 to `c` in its last row.
double off(const Program& program, double b, double c) {
  const Program whole = followed(program);
  double worst = 0;
  const std::size_t first = program.size() - 2, parts = whole.size() - 1 - first;
  const double part = c / static_cast<double>(parts);
  const Vec3 second = whole.poses()[first + 1].axis;
  const double sense = glm::length(second - axis_at(b, part)) < glm::length(second - axis_at(b, -part)) ? 1 : -1;
  for (std::size_t k = 0; k < parts; ++k)
    for (int i = 0; i <= 8; ++i) {
      const Motion motion(whole.poses()[first + k], whole.poses()[first + k + 1]);
      const double share = (static_cast<double>(k) + i / 8.0) / static_cast<double>(parts);
      worst = std::max(worst, glm::length(motion.axis(i / 8.0) - axis_at(b, sense * share * c)));
    }
  return worst;
}

TEST(Follow, SwingsHaveIntermediatePoses) {
  for (const char* code : {"G1", "G0"}) {
    const Program p = read_nc_text("G21 F100\nG1 X0 Y0 Z20 B45 C0\n" + std::string(code) + " C170", "head-table");
    ASSERT_EQ(p.size(), 2U) << "a block is one row";
    ASSERT_EQ(p.via().size(), 1U) << code;
    EXPECT_LT(off(p, 45, 170), 0.0021) << code;
    EXPECT_GT(glm::length(Motion(p.poses()[0], p.poses()[1]).axis(0.5) - axis_at(45, 85)), 0.6);
    const Program whole = followed(p);
    EXPECT_EQ(whole.rapid().back(), code[1] == '0');
    EXPECT_EQ(whole.line()[1], whole.line().back());
  }
}

TEST(Follow, MovesOnTheGreatCircleHaveNoIntermediatePoses) {
  for (const char* block : {"C2", "B-45", "X5 Y6", "B50"})
    EXPECT_TRUE(read_nc_text(std::string("G21 F100\nG1 X0 Y0 Z20 B45 C0\n") + block, "head-table").via().empty())
        << block;
  EXPECT_TRUE(read_nc_text("G21 F100\nG1 X0 Y0 Z20 B0 C0\nC270", "head-table").via().empty()) << "upright";
  // A whole turn ends at the axis at which it began.
  const Program turn = read_nc_text("G21 F100\nG1 X0 Y0 Z20 B45 C0\nC360", "head-table");
  EXPECT_GT(turn.via().at(1)->size(), 10U);
  EXPECT_LT(off(turn, 45, 360), 0.0021);
  EXPECT_TRUE(read_nc_text("G21 G1 B45 C170 F100", "head-table").via().empty()) << "the start is unknown";
}

TEST(Follow, AnOptionTurnsIntermediatePosesIntoRows) {
  const Program p = read_nc_text("G21 F100\nG1 X0 Y0 Z20 B45 C0\nG0 C170", "head-table", {{"axis_tolerance", 0.01}});
  EXPECT_GT(p.size(), 5U);
  EXPECT_TRUE(p.via().empty());
  EXPECT_TRUE(p.rapid()[1]) << "rapids, too";
}

TEST(Follow, RowsAndTheirSumsAreFoundAgain) {
  RowMap map;
  map.add(2, 3);
  map.add(3, 1);
  map.add(7, 2);
  const std::vector<std::size_t> wanted{0, 1, 2, 2, 2, 2, 3, 3, 4, 5, 6, 7, 7, 7, 8, 9};
  for (std::size_t k = 0; k < wanted.size(); ++k) EXPECT_EQ(map.original(k), wanted[k]) << k;
  EXPECT_EQ(map.sums(std::vector<double>(wanted.size(), 1)), (std::vector<double>{1, 1, 4, 2, 1, 1, 1, 3, 1, 1}));
  EXPECT_EQ(RowMap().sums({1, 2}), (std::vector<double>{1, 2}));
}

TEST(Follow, StaysWithTheProgramThroughEditsAndFiles) {
  const Program p = read_nc_text("G21 F100\nG1 X0 Y0 Z20 B45 C0\nC170\nX9", "head-table");
  const auto& via = *p.via().at(1);
  const auto same = [&](const Program& q, std::size_t row) {
    return q.via().contains(row) && q.via().at(row)->size() == via.size() &&
           std::equal(via.begin(), via.end(), q.via().at(row)->begin(),
                      [](const Pose& a, const Pose& b) { return a.tip == b.tip && a.axis == b.axis; });
  };
  EXPECT_TRUE(same(parse_program(to_bytes(p), "p"), 1));
  EXPECT_TRUE(same(scale_feeds(p, 2), 1) && same(trimmed(p, 0, 2), 1));
  EXPECT_TRUE(trimmed(p, 1, 3).via().empty()) << "nothing leads to a first row";
  const Program* two[] = {&p, &p};
  EXPECT_TRUE(same(joined(two), 1) && same(joined(two), 4));
  const Mat3 turn(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
  const Program turned = transformed(p, turn, {1, 2, 3});
  EXPECT_LT(glm::length(turned.via().at(1)->front().axis - turn * via.front().axis), 1e-15);
  EXPECT_EQ(followed(p).size(), p.size() + via.size());
}

TEST(Follow, IsWrittenAsTheMachineMoved) {
  const Program p = read_nc_text("G21 F100 T1 M6 S100 M3\nG1 X0 Y0 Z20 B45 C0\nC170\nX9", "head-table");
  WriteOptions how;
  how.post = "head-table";
  const Program back = read_nc_text(to_nc(p, how), "head-table");
  // On its path the tool leans along −y or +y, as the swing does, instead of passing over the top.
  double side = 0, top = 0;
  const Program whole = followed(back);
  for (const Pose& pose : whole.poses()) side = std::max(side, std::abs(pose.axis.y)), top = std::max(top, pose.axis.z);
  EXPECT_GT(side, 0.7);
  EXPECT_LT(top, 0.72);
}

/// The tips of the followed program.
std::vector<Vec3> tips(const std::string& text, const Options& options) {
  std::vector<Vec3> out;
  const Program whole = followed(read_nc_text("G21\n" + text, "3-axis", options));
  for (const Pose& pose : whole.poses()) out.push_back(pose.tip);
  return out;
}

TEST(Follow, RapidsGoAsTheMachineMoves) {
  const std::string text = "G0 X0 Y0 Z50\nX30 Y-10 Z20\nG1 X40 F100";
  const Options independent{{"rapids", std::string("independent")}};
  // All at one rate: Y is there first, then X and Z at once.
  EXPECT_EQ(tips(text, independent), (std::vector<Vec3>{{0, 0, 50}, {10, -10, 40}, {30, -10, 20}, {40, -10, 20}}));
  Options rates = independent;
  rates["rate_x"] = 30'000.0, rates["rate_y"] = 30'000.0, rates["rate_z"] = 15'000.0;
  EXPECT_EQ(tips(text, rates),
            (std::vector<Vec3>{{0, 0, 50}, {10, -10, 45}, {30, -10, 35}, {30, -10, 20}, {40, -10, 20}}));
  EXPECT_EQ(tips(text, {}).size(), 3U);
  const auto kinds = [&](const Options& options, const std::string& machine = "3-axis") {
    std::vector<std::string> out;
    for (const Note& n : read_nc_text("G21\n" + text, machine, options).notes) out.push_back(n.kind);
    return out;
  };
  EXPECT_EQ(kinds({}), std::vector<std::string>{"rapid"});
  EXPECT_TRUE(kinds({{"rapids", std::string("straight")}}).empty() && kinds(independent).empty());
  EXPECT_TRUE(kinds({{"rot_point", std::vector<double>{0, 0, 0}}}, "linuxcnc-xyzac").empty())
      << "LinuxCNC's are straight";
}

TEST(Follow, RotaryAxesOfADogLegTurnAtTheirOwnRate) {
  Options options{{"rapids", std::string("independent")}};
  options["rate_x"] = 1000.0, options["rate_c"] = 1000.0;
  const Program p = read_nc_text("G21 F100\nG1 X0 Y0 Z20 B45 C0\nG0 X100 C50", "head-table", options);
  // C is there after 0.05 min, X after 0.1: halfway the table stands.
  const Program whole = followed(p);
  for (std::size_t row = 1; row < whole.size(); ++row) {
    const bool done = std::abs(whole.poses()[row].axis.x - whole.poses().back().axis.x) < 1e-9;
    EXPECT_TRUE(done || whole.poses()[row].tip.x < 50);
  }
  EXPECT_GT(whole.size(), 4U);
}

}  // namespace
}  // namespace riffler::nc::follow_test
