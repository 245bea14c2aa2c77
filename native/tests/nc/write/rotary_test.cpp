#include "nc/write/rotary.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "nc/machine/machines.hpp"
#include "nc/write/subdivider.hpp"
#include "support/effort.hpp"
#include "support/nc_blocks.hpp"
#include "support/tilted.hpp"

namespace riffler::nc::rotary_test {
namespace {

using test::tilted;

using test::angle;
using test::axis_of;

constexpr double kAxisTolerance = 0.00175;

std::unique_ptr<Machine> tcp() {
  OptionReader none({}, "machine tcp");
  return make_machine("tcp", none);
}

Program feeds(const std::vector<Vec3>& axes) {
  Program p;
  for (std::size_t k = 0; k < axes.size(); ++k) p.append({{{static_cast<double>(k), 0, 0}, axes[k]}, 100});
  return p;
}

/// The joints at the rows' ends, of a machine without limits.
std::vector<Joints> choose(const Program& program, const Machine& machine, double axis_tolerance) {
  std::vector<Joints> out;
  for (const Waypoint& w : choose_joints(program, machine, axis_tolerance, free_moves(program))) {
    EXPECT_FALSE(w.rewound);
    EXPECT_EQ(w.row, out.size());
    out.push_back(w.joints);
  }
  EXPECT_EQ(out.size(), program.size());
  return out;
}

double way(const std::vector<Joints>& joints) {
  double sum = 0;
  for (std::size_t k = 1; k < joints.size(); ++k)
    sum += std::abs(joints[k][3] - joints[k - 1][3]) + std::abs(joints[k][5] - joints[k - 1][5]);
  return sum;
}

TEST(TcpMachine, PoseIsTheProductOfTheTwoRotations) {
  const auto machine = tcp();
  for (const double a : {-170.0, -90.0, -30.0, 0.0, 1e-5, 45.0, 90.0, 180.0})
    for (const double c : {-400.0, -90.0, 0.0, 33.0, 180.0, 720.0})
      EXPECT_LT(glm::length(machine->pose({1, 2, 3, a, 0, c}).axis - axis_of(a, c)), 1e-14);
  EXPECT_EQ(machine->pose({1, 2, 3, 50, 0, 60}).tip, Vec3(1, 2, 3));
}

TEST(TcpMachine, BothBranchesHoldThePoseAndKeepNearTheJointsBefore) {
  const auto machine = tcp();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 o = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    const Joints near{0, 0, 0, 40 * normal(random), 0, 500 * normal(random)};
    for (const int branch : {0, 1}) {
      const Joints j = machine->joints({{0, 0, 0}, o}, branch, near, 1e-6);
      EXPECT_LT(glm::length(axis_of(j[3], j[5]) - o), 1e-12);
      EXPECT_LE(std::abs(j[5] - near[5]), 180 + 1e-9);
      EXPECT_LE(std::abs(j[3] - near[3]), 180 + 1e-9);
    }
  }
}

TEST(ChooseJoints, TurnsManyTimesWithoutAJump) {
  std::vector<Vec3> axes;
  for (int k = 0; k <= 300; ++k) axes.push_back(tilted(20, 10.0 * k));
  const auto joints = choose(feeds(axes), *tcp(), kAxisTolerance);
  for (std::size_t k = 1; k < joints.size(); ++k) EXPECT_NEAR(joints[k][5] - joints[k - 1][5], 10, 1e-9);
  EXPECT_NEAR(joints.back()[5] - joints.front()[5], 3000, 1e-8);
}

TEST(ChooseJoints, SwingsThroughThePoleByTheSignOfA) {
  std::vector<Vec3> axes;
  for (int k = -10; k <= 10; ++k) axes.push_back(tilted(3 * k, 77));
  const auto joints = choose(feeds(axes), *tcp(), kAxisTolerance);
  EXPECT_NEAR(way(joints), 60, 1e-6) << "C never turns";
  for (std::size_t k = 0; k < joints.size(); ++k)
    EXPECT_LT(angle(axis_of(joints[k][3], joints[k][5]), axes[k]), 1.1e-6);
}

TEST(ChooseJoints, KeepsCWhereItIsFree) {
  std::vector<Vec3> axes{tilted(0, 0), tilted(20, 130),   tilted(1e-6, 0),
                         tilted(0, 0), tilted(2e-6, 250), tilted(20, 150)};
  const auto joints = choose(feeds(axes), *tcp(), kAxisTolerance);
  for (std::size_t k : {0U, 2U, 3U, 4U}) EXPECT_EQ(joints[k][5], joints[1][5]);
  EXPECT_NEAR(way(joints), 20 + 20 + 20 + 20, 1e-4);
  // The same downwards, where C is free too.
  for (Vec3& axis : axes) axis.z = -axis.z;
  const auto below = choose(feeds(axes), *tcp(), kAxisTolerance);
  EXPECT_NEAR(way(below), way(joints), 1e-4);
}

/// All 2^n choices of branches, with the rule that only rapids above everything may change them.
double shortest_way(const Program& p, const Machine& machine) {
  const std::vector<bool> free = free_moves(p);
  double best = std::numeric_limits<double>::infinity();
  for (unsigned mask = 0; mask < 1U << p.size(); ++mask) {
    double sum = 0;
    bool allowed = true;
    Joints before{};
    for (std::size_t row = 0; row < p.size() && allowed; ++row) {
      const unsigned branch = mask >> row & 1;
      if (row > 0 && !free[row] && branch != (mask >> (row - 1) & 1)) allowed = false;
      const Joints j = machine.joints(p.poses()[row], static_cast<int>(branch), before, 1e-6);
      if (row > 0) sum += std::abs(j[3] - before[3]) + std::abs(j[5] - before[5]);
      before = j;
    }
    if (allowed) best = std::min(best, sum);
  }
  return best;
}

TEST(ChooseJoints, IsTheShortestOfAllChoicesOverTheWholeProgram) {
  const auto machine = tcp();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit;
  for (int round = 0; round < 60; ++round) {
    Program p;
    for (int k = 0; k < 9; ++k) {
      const bool rapid = unit(random) < 0.6;
      p.append({{{0.0 + k, 0, rapid ? 10.0 : 0.0}, tilted(15 + 60 * unit(random), 360 * unit(random))},
                100,
                0,
                1,
                0,
                rapid});
    }
    EXPECT_NEAR(way(choose(p, *machine, kAxisTolerance)), shortest_way(p, *machine), 1e-4) << "round " << round;
  }
}

/// Largest distance of the blocks' axis from the great circle at the same share of the move, and of the tip from the
/// line.
std::pair<double, double> errors(const Machine& machine, const Pose& a, const Pose& b, const Joints& ja,
                                 const std::vector<Joints>& ends) {
  const Motion motion(a, b);
  const double span = b.tip.x - a.tip.x;
  double axis = 0, tip = 0;
  Joints from = ja;
  for (const Joints& to : ends) {
    for (int i = 0; i <= 200; ++i) {
      Joints j;
      for (std::size_t k = 0; k < 6; ++k) j[k] = from[k] + i / 200.0 * (to[k] - from[k]);
      const double t = (j[0] - a.tip.x) / span;
      axis = std::max(axis, angle(axis_of(j[3], j[5]), motion.axis(t)));
      tip = std::max(tip, glm::length(machine.pose(j).tip - motion.tip(t)));
    }
    from = to;
  }
  return {axis, tip};
}

TEST(Subdivider, HoldsTheAxisBetweenBlocksForAnyMove) {
  const auto machine = tcp();
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit;
  std::size_t most = 0;
  for (int round = 0; round < test::cases(1500); ++round) {
    Vec3 oa = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    Vec3 ob = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    if (round % 3 == 1) {
      // Past the pole (or its opposite) at a distance from 1e-8 rad to a degree.
      const double around = 360 * unit(random), off = std::pow(10, -8 + 6.3 * unit(random)) / kDegree;
      oa = tilted(60 * unit(random), around), ob = tilted(-60 * unit(random), around);
      const Vec3 side = tilted(off, around + 90);
      const double c = std::cos(off * kDegree), s = std::sin(off * kDegree);
      const Vec3 n(side.x / s, side.y / s, 0);
      for (Vec3* o : {&oa, &ob}) *o = glm::normalize(c * *o + s * n * glm::dot(*o, Vec3(0, 0, 1)));
      if (unit(random) < 0.3) oa.z = -oa.z, ob.z = -ob.z;
    }
    if (round % 3 == 2) oa = tilted(unit(random) < 0.5 ? 0 : 1e-5 * unit(random), 360 * unit(random));
    if (glm::dot(oa, ob) < -0.999999) continue;
    const double tolerance = round % 2 ? kAxisTolerance : 1e-4;
    Program p;
    p.append({{{0, 0, 0}, oa}, 100});
    p.append({{{10, 5, 3}, ob}, 100});
    const auto joints = choose(p, *machine, tolerance);
    Subdivider splitter(*machine, 0.01, tolerance);
    const auto& ends = splitter.split(p.poses()[0], joints[0], p.poses()[1], joints[1], false);
    EXPECT_EQ(ends.back(), joints[1]) << "the row is the end of a block";
    const auto [axis, tip] = errors(*machine, p.poses()[0], p.poses()[1], joints[0], ends);
    EXPECT_LE(axis, tolerance + 2e-6) << "round " << round;
    EXPECT_LE(tip, 1e-12);
    most = std::max(most, ends.size());
  }
  EXPECT_LE(most, 1000U);
}

TEST(Subdivider, AddsNothingWhereNothingTurnsAndInRapids) {
  const auto machine = tcp();
  Program p = feeds({tilted(30, 40), tilted(30, 40), tilted(30, 40)});
  p.append({{{50, 0, 0}, tilted(30, 170)}, 0, 0, 0, 0, true});
  const auto joints = choose(p, *machine, kAxisTolerance);
  Subdivider splitter(*machine, 0.01, kAxisTolerance);
  for (std::size_t row = 1; row < p.size(); ++row)
    EXPECT_EQ(splitter.split(p.poses()[row - 1], joints[row - 1], p.poses()[row], joints[row], p.rapid()[row]).size(),
              1U);
}

TEST(ChooseJoints, NamesTheRowThatCannotBeHeld) {
  OptionReader none({}, "machine 3-axis");
  const auto upright = make_machine("3-axis", none);
  const auto error = [](const Program& p, const Machine& machine) -> std::string {
    try {
      choose_joints(p, machine, kAxisTolerance, free_moves(p));
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(error(feeds({{0, 0, 1}, {0, 0, 1}, tilted(0.001, 0)}), *upright).find("poses, row 2"), std::string::npos);
  EXPECT_EQ(error(feeds({{0, 0, 1}, tilted(3e-5, 0)}), *upright), "");
  EXPECT_NE(error(feeds({{0, 0, 1}, {0, 0, -1}}), *tcp()).find("poses, row 1"), std::string::npos);
  Program rapid = feeds({{0, 0, 1}});
  rapid.append({{{0, 0, 9}, {0, 0, 1}}, 0, 0, 0, 0, true});
  rapid.append({{{5, 0, 9}, {0, 0, -1}}, 0, 0, 0, 0, true});
  EXPECT_EQ(error(rapid, *tcp()), "");
  rapid.append({{{5, 0, 0}, {0, 0, 1}}, 0, 0, 0, 0, true});
  EXPECT_NE(error(rapid, *tcp()).find("poses, row 3: the axis is opposite"), std::string::npos) << "into the part";
}

/// A head that nutates by 45° under a fork: the free axis turns with the tilt, too. B goes one way only.
Machine nutating() {
  const Vec3 z(0, 0, 1), oblique = glm::normalize(Vec3(0, 1, 1));
  MachineDescription out{"nutating", {{'C', z, {0, 0, 200}, false}, {'B', oblique, {0, 0, 200}, false}}, {}, false, {}};
  out.ranges[4] = {-1, 181};
  return Machine(out);
}

TEST(ChooseJoints, CountsWholeTurnsAlongTheGreatCircleBesideThePole) {
  // One long move past the pole turns C by more than half a turn where the other axis leans: the nearest turn of its
  // end is not where the path leads.
  const Machine machine = nutating();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit;
  int beyond_half = 0;
  for (int n = 0; n < 200; ++n) {
    const double around = 360 * unit(random);
    const Program p =
        feeds({tilted(5 + 75 * unit(random), around), tilted(5 + 75 * unit(random), around + 165 + 30 * unit(random))});
    const auto way = choose_joints(p, machine, kAxisTolerance, free_moves(p));
    ASSERT_EQ(way.size(), 2U);
    beyond_half += std::abs(way[1].joints[5] - way[0].joints[5]) > 180;
    Subdivider splitter(machine, 0.01, kAxisTolerance);
    Joints before = way[0].joints;
    const Motion motion(p.poses()[0], p.poses()[1]);
    double worst = 0;
    for (const Joints& joints : splitter.split(motion.from(), way[0].joints, motion.to(), way[1].joints, false)) {
      for (int k = 0; k <= 20; ++k) {
        const Pose is = machine.pose(mix(before, joints, k / 20.0));
        const double share = glm::dot(is.tip - motion.from().tip, motion.to().tip - motion.from().tip);  // 1 mm
        worst = std::max(worst, glm::length(is.tip - motion.tip(share)));
      }
      before = joints;
    }
    EXPECT_LT(worst, 0.01) << n;
  }
  EXPECT_GT(beyond_half, 5);
}

TEST(Subdivider, ChangesTheBranchOnlyWhereTheMovePassesThePole) {
  for (const Machine& machine : {nutating(), *tcp()}) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit;
    for (int n = 0; n < 200; ++n) {
      const double around = 360 * unit(random), off = 0.02 * (unit(random) - 0.5);
      const Pose a{{0, 0, 0}, tilted(1 + 70 * unit(random), around)};
      const Pose b{{1, 0, 0}, tilted(1 + 20 * unit(random), around + 180 + off)};
      const Joints from = machine.joints(a, 0, {}, 1e-6), to = machine.joints(b, 1, from, 1e-6);
      Subdivider splitter(machine, 0.01, kAxisTolerance);
      const Motion motion(a, b);
      Joints before = from;
      for (const Joints& joints : splitter.split(a, from, b, to, false)) {
        for (int k = 0; k <= 20; ++k) {
          const Pose is = machine.pose(mix(before, joints, k / 20.0));
          const double share = std::clamp(is.tip.x, 0.0, 1.0);
          ASSERT_LT(glm::length(is.tip - motion.tip(share)), 0.01) << n;
          ASSERT_LT(std::abs(glm::dot(is.axis, motion.rotation())) / motion.angle(), kAxisTolerance) << n;
        }
        before = joints;
      }
    }
  }
}

TEST(Subdivider, DoesNotTakeWholeTurnsForRest) {
  // Twenty turns with the tip held look like rest at every tenth of them.
  OptionReader origin({{"rot_point", std::vector<double>{0, 0, 0}}}, "machine linuxcnc-xyzac");
  const auto machine = make_machine("linuxcnc-xyzac", origin);
  const Pose pose{{30, 0, 5}, tilted(20, 40)};
  const Joints from = machine->joints(pose, 0, {}, 1e-6);
  Joints to = from;
  to[5] += 7200;
  Subdivider splitter(*machine, 0.01, kAxisTolerance);
  Joints before = from;
  double worst = 0;
  for (const Joints& joints : splitter.split(pose, from, pose, machine->with_tip(to, pose.tip), true)) {
    for (int k = 0; k <= 100; ++k)
      worst = std::max(worst, glm::length(machine->pose(mix(before, joints, k / 100.0)).tip - pose.tip));
    before = joints;
  }
  EXPECT_LT(worst, 0.01);
}

TEST(Subdivider, RefusesMovesThatTheAxesCannotFollow) {
  const auto machine = tcp();
  const Pose a{{0, 0, 0}, tilted(30, 0)}, b{{1, 0, 0}, tilted(30, 60)};
  const Joints from = machine->joints(a, 0, {}, 1e-6), to = machine->joints(b, 1, from, 1e-6);
  Subdivider splitter(*machine, 0.01, kAxisTolerance);
  EXPECT_THROW(splitter.split(a, from, b, to, false), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::nc::rotary_test
