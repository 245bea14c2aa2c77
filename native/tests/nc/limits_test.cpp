// Limits of rotary axes: which turns and branches are left, and where the tool must leave to turn an axis back.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "nc/machine/machines.hpp"
#include "nc/write/rotary.hpp"
#include "riffler/nc/cutter_path.hpp"
#include "riffler/nc/read/reader.hpp"
#include "riffler/nc/write/writer.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/nc_blocks.hpp"
#include "support/tilted.hpp"

namespace riffler::nc::limits_test {
namespace {

const std::vector<double> kOrigin{0, 0, 0};

using test::tilted;

constexpr double kDegree = 3.141592653589793 / 180;
constexpr double kAxisTolerance = 0.00175;

std::unique_ptr<Machine> tcp(Options options) {
  OptionReader reader(std::move(options), "machine tcp");
  return make_machine("tcp", reader);
}

Options limits(double a_low, double a_high, double c_low, double c_high) {
  return {{"limits_a", std::vector<double>{a_low, a_high}}, {"limits_c", std::vector<double>{c_low, c_high}}};
}

/// A cut on a circle whose axis leans outwards by `tilt`, `turns` round, `rows` a turn.
CutterPath round(double tilt, double turns, int rows, double start = 0) {
  CutterPath path{{}, {600}, 8000, 1};
  const int n = static_cast<int>(std::lround(std::abs(turns) * rows));
  for (int k = 0; k <= n; ++k) {
    const double angle = start + 360 * turns * k / n;
    path.poses.push_back(
        {{30 * std::cos(angle * kDegree), 30 * std::sin(angle * kDegree), -0.1 * k / rows}, tilted(tilt, angle)});
  }
  return path;
}

int rewinds(const std::vector<Waypoint>& way) {
  return static_cast<int>(std::count_if(way.begin(), way.end(), [](const Waypoint& w) { return w.rewound; }));
}

/// Within limits everywhere, holding every row's pose, going on evenly except where the tool leaves.
void check(const Program& p, const Machine& machine, const std::vector<Waypoint>& way) {
  std::size_t rows = 0;
  for (std::size_t k = 0; k < way.size(); ++k) {
    const Waypoint& w = way[k];
    EXPECT_EQ(machine.beyond(w.joints, 1e-8), 6U) << "row " << w.row;
    if (w.share == 1 && !w.rewound) {
      EXPECT_EQ(w.row, rows++);
      EXPECT_LT(test::angle(machine.pose(w.joints).axis, p.poses()[w.row].axis), 1.1e-6);
    }
    if (w.rewound) {
      ASSERT_GT(k, 0U);
      EXPECT_LT(test::angle(machine.pose(w.joints).axis, machine.pose(way[k - 1].joints).axis), 1e-9);
      EXPECT_LT(glm::length(machine.pose(w.joints).tip - machine.pose(way[k - 1].joints).tip), 1e-9);
    }
  }
  EXPECT_EQ(rows, p.size());
}

TEST(Limits, HaveNoEffectIfTheyAreNotMet) {
  const Program p = program_from_paths(std::vector{round(25, 0.8, 40)}, {});
  const auto free = choose_joints(p, *tcp({}), kAxisTolerance, free_moves(p));
  const auto bound = choose_joints(p, *tcp(limits(-90, 90, -1000, 1000)), kAxisTolerance, free_moves(p));
  ASSERT_EQ(free.size(), bound.size());
  for (std::size_t k = 0; k < free.size(); ++k) EXPECT_EQ(free[k].joints, bound[k].joints);
}

TEST(Limits, StartWhereTheWholePathFits) {
  // One turn and a half within ±360°: only from one end to the other.
  const Program p = program_from_paths(std::vector{round(25, 1.5, 40)}, {});
  const auto machine = tcp(limits(-90, 90, -360, 360));
  const auto way = choose_joints(p, *machine, kAxisTolerance, free_moves(p));
  EXPECT_EQ(rewinds(way), 0);
  check(p, *machine, way);
}

/// Places of C are `at` + 180° m (branches by turns): the fewest stretches of one m that cover all rows, each beginning
/// at the row at which the one before ends.
int fewest_rewinds(const std::vector<double>& at, double low, double high) {
  int stretches = 0;
  for (std::size_t row = 0; row + 1 < at.size(); ++stretches) {
    std::size_t furthest = row;
    for (int m = -20; m <= 20; ++m) {
      std::size_t end = row;
      while (end < at.size() && at[end] + 180 * m >= low && at[end] + 180 * m <= high) ++end;
      furthest = std::max(furthest, end - (end > row));
    }
    row = furthest;
  }
  return stretches - 1;
}

TEST(Limits, MakeTheToolLeaveAsOftenAsTheyMustAndNoMore) {
  for (const double turns : {2.2, 5.0, -3.3}) {
    const Program p = program_from_paths(std::vector{round(25, turns, 40, 7)}, {});
    const auto machine = tcp(limits(-90, 90, -360, 360));
    const auto way = choose_joints(p, *machine, kAxisTolerance, free_moves(p));
    check(p, *machine, way);
    std::vector<double> places;
    const int n = static_cast<int>(std::lround(std::abs(turns) * 40));
    for (int k = 0; k <= n; ++k) places.push_back(7 + 90 + 360 * turns * k / n);
    EXPECT_EQ(rewinds(way), fewest_rewinds(places, -360, 360)) << turns;
  }
}

TEST(Limits, AreMetInTheMiddleOfAMoveWithinPartOfATurn) {
  // ±180°: each place is there once (twice on the seam), so the seam must be passed outside, wherever it lies.
  const Program p = program_from_paths(std::vector{round(25, 1.9, 11, 33)}, {});
  const auto machine = tcp(limits(0, 90, -180, 180));
  const auto way = choose_joints(p, *machine, kAxisTolerance, free_moves(p));
  check(p, *machine, way);
  EXPECT_EQ(rewinds(way), 2);
  int inner = 0;
  for (const Waypoint& w : way) inner += w.share < 1 && !w.rewound;
  EXPECT_EQ(inner, 2) << "the seam lies between rows";
}

TEST(Limits, ChangeTheBranchIfTheTiltingAxisTurnsInOneDirectionOnly) {
  // A swing through the pole: A cannot turn below −5°, so C turns half round there.
  CutterPath path{{}, {600}, 8000, 1};
  for (int k = -10; k <= 10; ++k) path.poses.push_back({{1.0 * k, 0, 0}, tilted(3 * k, 77)});
  const Program p = program_from_paths(std::vector{path}, {});
  const auto machine = tcp(limits(-5, 90, -360, 360));
  const auto way = choose_joints(p, *machine, kAxisTolerance, free_moves(p));
  check(p, *machine, way);
  EXPECT_EQ(rewinds(way), 0) << "at the pole the other branch is reached without leaving";
  EXPECT_EQ(rewinds(choose_joints(p, *tcp(limits(-90, 90, -360, 360)), kAxisTolerance, free_moves(p))), 0);
}

TEST(Limits, BesideThePoleTheToolLeavesToChangeTheBranch) {
  CutterPath path{{}, {600}, 8000, 1};
  for (int k = 0; k <= 40; ++k) path.poses.push_back({{1.0 * k, 0, 0}, tilted(40, 4.0 * k)});
  const Program p = program_from_paths(std::vector{path}, {});
  // On one branch C goes from 90° to 250°, on the other from −90° to 70°.
  const auto machine = tcp(limits(-90, 90, -50, 50));
  EXPECT_THROW(choose_joints(p, *machine, kAxisTolerance, free_moves(p)), std::invalid_argument);
  EXPECT_EQ(rewinds(choose_joints(p, *tcp(limits(-90, 90, -100, 100)), kAxisTolerance, free_moves(p))), 0);
  const auto wide = tcp(limits(-90, 90, 0, 180));
  const auto way = choose_joints(p, *wide, kAxisTolerance, free_moves(p));
  check(p, *wide, way);
  EXPECT_EQ(rewinds(way), 1);
}

/// The least number of rows at which the tool leaves, over all paths through the places (A, C + 360° m) and
/// (−A, C + 180° + 360° m) of every row that leave at rows only; −1 where there is none. No move passes the pole.
int least_leavings(const std::vector<double>& tilt, const std::vector<double>& around, double a_low, double a_high,
                   double c_low, double c_high) {
  constexpr int kNone = 1000, kTurns = 6;
  using Places = std::array<int, 2 * (2 * kTurns + 1)>;  // by branch and turn
  const auto open = [&](std::size_t row, std::size_t place) {
    const bool first = place % 2 == 0;
    const double a = first ? tilt[row] : -tilt[row];
    const double c = around[row] + 90 + (first ? 0 : 180) + 360 * (static_cast<int>(place / 2) - kTurns);
    return a >= a_low && a <= a_high && c >= c_low && c <= c_high;
  };
  Places now;
  for (std::size_t p = 0; p < now.size(); ++p) now[p] = open(0, p) ? 0 : kNone;
  for (std::size_t row = 1; row < tilt.size(); ++row) {
    const int least = *std::min_element(now.begin(), now.end());
    for (std::size_t p = 0; p < now.size(); ++p) {
      if (open(row - 1, p)) now[p] = std::min(now[p], least + 1);
      if (!open(row, p)) now[p] = kNone;
    }
  }
  const int least = *std::min_element(now.begin(), now.end());
  return least < kNone ? least : -1;
}

TEST(Limits, MakeTheToolLeaveAsSeldomAsTheBestOfAllSolutions) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit;
  int counts[4]{};
  for (int n = 0; n < 400; ++n) {
    std::vector<double> tilt, around;
    CutterPath path{{}, {600}, 8000, 1};
    double up = 20 + 30 * unit(random), at = -180 + 360 * unit(random), drift = 120 * (unit(random) - 0.5);
    for (int k = 0; k < 40; ++k) {
      if (unit(random) < 0.1) drift = 120 * (unit(random) - 0.5);
      tilt.push_back(up), around.push_back(at);
      path.poses.push_back({{1.0 * k, 0, 0}, tilted(up, at)});
      up = std::clamp(up + 10 * (unit(random) - 0.5), 15.0, 60.0), at += drift;
    }
    const double a_low = unit(random) < 0.5 ? 0 : -90, c_low = -600 * unit(random);
    const double c_high = c_low + 370 + 800 * unit(random);
    const Program p = program_from_paths(std::vector{path}, {});
    const auto machine = tcp(limits(a_low, 90, c_low, c_high));
    // Rows of program_from_paths before and after the path stand above it.
    const int least = least_leavings(tilt, around, a_low, 90, c_low, c_high);
    if (least < 0) continue;
    const auto way = choose_joints(p, *machine, kAxisTolerance, free_moves(p));
    check(p, *machine, way);
    EXPECT_EQ(rewinds(way), least) << n;
    ++counts[std::min(least, 3)];
  }
  for (const int count : counts) EXPECT_GT(count, 10);
}

TEST(Limits, AnyProgramIsHeldWithinThemOrRefusedByRow) {
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit;
  int held = 0;
  for (int round = 0; round < 300; ++round) {
    CutterPath path{{}, {600}, 8000, 1};
    Vec3 axis = tilted(50 * unit(random), 360 * unit(random));
    for (int k = 0; k < 30; ++k) {
      axis = glm::normalize(axis + 0.3 * Vec3(normal(random), normal(random), normal(random)));
      if (axis.z < 0.2) axis = glm::normalize(Vec3(axis.x, axis.y, 0.2));
      path.poses.push_back({{2.0 * k, normal(random), 0}, axis});
    }
    const Program p = program_from_paths(std::vector{path}, {});
    const double a = 60 + 30 * unit(random), c = 180 + 200 * unit(random);
    const auto machine = tcp(limits(-a, a, -c, c));
    try {
      check(p, *machine, choose_joints(p, *machine, kAxisTolerance, free_moves(p)));
      ++held;
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find("poses, row "), std::string::npos);
      EXPECT_NE(std::string(e.what()).find("A would stand at"), std::string::npos) << e.what();
    }
  }
  EXPECT_GT(held, 100);
}

TEST(Limits, AreKeptByAnAxisThatIsFreeThroughout) {
  CutterPath path{{}, {600}, 8000, 1};
  for (int k = 0; k < 5; ++k) path.poses.push_back({{1.0 * k, 0, 0}, {0, 0, 1}});
  const Program p = program_from_paths(std::vector{path}, {});
  const auto machine = tcp(limits(-5, 90, 10, 350));
  for (const Waypoint& w : choose_joints(p, *machine, kAxisTolerance, free_moves(p))) EXPECT_EQ(w.joints[5], 10);
}

TEST(Limits, LeaveAsSeldomAsAllTurnsOfAWideRangeAllow) {
  // C turns on by 350° and then back by 1070°: within ±720° only where it begins a turn up, neither at the nearest turn
  // nor at the ends.
  CutterPath path{{}, {600}, 8000, 1};
  for (int k = 0; k <= 142; ++k) {
    const double around = k <= 35 ? 10.0 * k : 350 - 10.0 * (k - 35);
    path.poses.push_back({{0.1 * k, 0, 0}, tilted(30, around - 90)});
  }
  const Program p = program_from_paths(std::vector{path}, {});
  const auto machine = tcp(limits(0, 90, -720, 720));
  const auto way = choose_joints(p, *machine, kAxisTolerance, free_moves(p));
  check(p, *machine, way);
  EXPECT_EQ(rewinds(way), 0);
}

TEST(Limits, ThroughThePoleTheFreeAxisTurnsInTheRemainingDirection) {
  // A cannot go below 0, so C turns half round at the pole: up from 100° would pass 180°, down does not.
  for (const double around : {10.0, 190.0}) {
    CutterPath path{{}, {600}, 8000, 1};
    for (int k = -10; k <= 10; ++k) path.poses.push_back({{1.0 * k, 0, 0}, tilted(3.0 * k, around)});
    const Program p = program_from_paths(std::vector{path}, {});
    const auto machine = tcp(limits(0, 90, -180, 180));
    const auto way = choose_joints(p, *machine, kAxisTolerance, free_moves(p));
    check(p, *machine, way);
    EXPECT_EQ(rewinds(way), 0) << around;
  }
}

WriteOptions post(const char* name, Options options) {
  WriteOptions out;
  out.post = name, out.options = std::move(options);
  return out;
}

TEST(Rewinds, LeaveUpwardsTurnThereAndComeBack) {
  const Program p = program_from_paths(std::vector{round(25, 2.2, 40)}, {});
  for (const char* name : {"tcp", "linuxcnc-xyzac"}) {
    Options options = limits(-90, 90, -360, 360);
    if (name != std::string("tcp")) options["rot_point"] = kOrigin;
    WriteReport report;
    const std::string text = to_nc(p, post(name, options), &report);
    ASSERT_EQ(report.rewinds.size(), 1U);
    const Program q = parse_nc(text, "p.ngc", {name, options});
    double highest = 0;
    for (const Pose& pose : p.poses()) highest = std::max(highest, pose.tip.z);
    // In the part's coordinates C never turns more than a little below safe height, except with the path.
    std::size_t above = 0, at = 0;
    for (std::size_t row = 1; row < q.size(); ++row) {
      above += q.poses()[row].tip.z > highest - 1e-4 && q.poses()[row - 1].tip.z > highest - 1e-4;
      if (at < p.size() && glm::length(q.poses()[row].tip - p.poses()[at].tip) < 3e-5) ++at;
      if (q.rapid()[row]) continue;
      EXPECT_LT(q.poses()[row].tip.z, 1.1) << "feed only near the path";
    }
    EXPECT_GT(above, 0U) << name;
    for (const auto& block : test::block_ends(text))
      for (const char letter : {'A', 'C'}) {
        if (!block.at.contains(letter)) continue;
        EXPECT_LE(std::abs(block.at.at(letter)), letter == 'A' ? 90.0 : 360.0);
      }
  }
}

TEST(Rewinds, HoldTheTipOverWholeTurnsToo) {
  // From one end of ±3600° to the other: some twenty turns, which samples see as rest.
  const Program p = program_from_paths(std::vector{round(25, 38, 40)}, {});
  const Options options{
      {"limits_c", std::vector<double>{-3600, 3600}}, {"limits_a", std::vector<double>{0, 90}}, {"rot_point", kOrigin}};
  WriteReport report;
  const std::string text = to_nc(p, post("linuxcnc-xyzac", options), &report);
  ASSERT_EQ(report.rewinds.size(), 1U);
  double most = 0, back = 0;
  const auto blocks = test::block_ends(text);
  for (std::size_t k = 1; k < blocks.size(); ++k) {
    if (!blocks[k].rapid || !blocks[k - 1].at.contains('C')) continue;
    const double turned = std::abs(blocks[k].at.at('C') - blocks[k - 1].at.at('C'));
    most = std::max(most, turned), back += turned;
  }
  EXPECT_GT(back, 6500);
  EXPECT_LT(most, 10) << "a tip 30 mm from the axis leaves its place by 0.03 mm in 5°";
}

TEST(Rewinds, GoHigherWhereTheToolHangsBelowItsTip) {
  CutterPath path{{}, {600}, 8000, 1};
  for (int k = 0; k <= 100; ++k) path.poses.push_back({{30 + 0.1 * k, 0, 0}, tilted(100, 5.0 * k)});
  Program p = program_from_paths(std::vector{path}, {});
  const Tool tool = cutters::ball(6, 50);
  double highest[2];
  for (const bool known : {false, true}) {
    if (known) p.tools.emplace(1, tool);
    WriteReport report;
    const Program q = parse_nc(to_nc(p, post("tcp", limits(0, 120, -180, 180)), &report), "p.ngc", {"tcp", {}});
    ASSERT_GE(report.rewinds.size(), 1U);
    highest[known] = 0;
    for (const Pose& pose : q.poses()) highest[known] = std::max(highest[known], pose.tip.z);
  }
  EXPECT_NEAR(highest[1] - highest[0], 50 * std::sin(10 * kDegree) + 3 * std::cos(10 * kDegree), 1e-4);
}

TEST(Rewinds, GoToTheGivenSafeHeightAndRapidsTurnFreelyOnlyThere) {
  const Program p = program_from_paths(std::vector{round(25, 2.2, 40), round(25, 0.1, 40)}, {});
  double clear = 0;  // of the program's own rapids
  for (const Pose& pose : p.poses()) clear = std::max(clear, pose.tip.z);
  Options options = limits(-90, 90, -360, 360);
  for (const double safe : {clear, clear + 50}) {
    options["safe_height"] = safe, options["rot_point"] = kOrigin;
    WriteReport report;
    const std::string text = to_nc(p, post("linuxcnc-xyzac", options), &report);
    EXPECT_EQ(report.rewinds.size(), 1U);
    const Program q = parse_nc(text, "p.ngc", {"linuxcnc-xyzac", options});
    double highest = 0;
    for (const Pose& pose : q.poses()) highest = std::max(highest, pose.tip.z);
    EXPECT_NEAR(highest, safe, 0.01) << "the tip is held within the tolerance while axes turn";
    const std::vector<bool> free = free_moves(p, safe);
    EXPECT_EQ(std::count(free.begin(), free.end(), true) > 0, safe == clear);
  }
  options["safe_height"] = 0.0;
  try {
    to_nc(p, post("linuxcnc-xyzac", options));
    FAIL();
  } catch (const RowError& e) {
    EXPECT_NE(std::string(e.what()).find("safe_height 0 must be above every feed move"), std::string::npos) << e.what();
  }
}

TEST(Rewinds, NameTheAxisThatNoTurnBringsWithinItsLimits) {
  const Program p = program_from_paths(std::vector{round(70, 0.5, 40)}, {});
  try {
    Options options = limits(-30, 50, -360, 360);
    options["rot_point"] = kOrigin;
    to_nc(p, post("linuxcnc-xyzac", options));
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_EQ(std::string(e.what()),
              "poses, row 0: machine linuxcnc-xyzac cannot hold it within its limits: A would stand at 70 (-30 to 50); "
              "A would stand at -70 (-30 to 50); place the part differently or tilt the tool less");
  }
}

TEST(Rewinds, LinearLimitsBindWhereTheWordsAreJoints) {
  const Program p = program_from_paths(std::vector{round(20, 0.5, 40)}, {});
  const Options narrow{{"limits_y", std::vector<double>{-5, 5}}};
  EXPECT_NO_THROW(to_nc(p, post("tcp", narrow))) << "the tip's place says nothing about the axis";
  Options table = narrow;
  table["rot_point"] = kOrigin;
  EXPECT_THROW(to_nc(p, post("linuxcnc-xyzac", table)), RowError);
}

TEST(PolePassages, AreReportedWithWhatTheyCost) {
  CutterPath path{{}, {3000}, 8000, 1};
  for (int k = -20; k <= 20; ++k) path.poses.push_back({{0.1 * k, 0, 0}, glm::normalize(Vec3(0.01 * k, 0.002, 1))});
  const Program p = program_from_paths(std::vector{path}, {});
  WriteReport report;
  to_nc(p, post("linuxcnc-xyzac", {{"max_rotary", 2000.0}, {"rot_point", kOrigin}}), &report);
  ASSERT_EQ(report.passages.size(), 1U);
  const PolePassage& passage = report.passages[0];
  EXPECT_NEAR(static_cast<double>(passage.first + passage.last) / 2, 22, 1);
  EXPECT_GT(passage.rotary, 100);
  EXPECT_LT(passage.tool, 5);
  EXPECT_GT(passage.slowed, 10);
  EXPECT_GT(report.slowed, 5U);
}

}  // namespace
}  // namespace riffler::nc::limits_test
