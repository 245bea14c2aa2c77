// The contact of a cutter with a stock: compared with dense sums over points, along slides, and for degenerate poses.
#include "riffler/collide/stock_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "geom/math.hpp"
#include "riffler/sweep/move_carver.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"
#include "support/allocations.hpp"
#include "support/effort.hpp"

namespace riffler::collide::stock_contact_test {
namespace {

constexpr double kStiffness = 10;
const Box3 kBox{{0, 0, 0}, {24, 20, 10}};
const Vec3 kUp(0, 0, 1);

using Solid = std::function<bool(const Vec3&)>;

bool in_block(const Vec3& p) {
  return p.x >= 0 && p.x <= 24 && p.y >= 0 && p.y <= 20 && p.z >= 0 && p.z <= 10;
}

/// Force and torque of the law k · normal · dV, point by point; knows neither rays nor tangent planes.
struct Dense {
  Vec3 force{0}, torque{0};
  double volume = 0;
};

Dense dense(const Tool& tool, const Pose& pose, const Solid& solid, const Box3& where, double h) {
  const tool::Outline outline(tool);
  Dense out;
  const Vec3 n = glm::ceil(where.size() / h);
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) {
        const Vec3 p = where.lower + h * Vec3(i + 0.5, j + 0.5, k + 0.5), d = p - pose.tip;
        if (!solid(p)) continue;
        const double z = glm::dot(d, pose.axis), rho = glm::length(d - z * pose.axis);
        if (!outline.inside(rho, z)) continue;
        const auto nearest = outline.nearest(rho, z);
        const Vec3 radial = rho > 0 ? (d - z * pose.axis) / rho : Vec3(0);
        const Vec3 push = -kStiffness * h * h * h * (nearest.normal.x * radial + nearest.normal.y * pose.axis);
        out.force += push, out.torque += glm::cross(d, push), out.volume += h * h * h;
      }
  return out;
}

struct Found {
  Contact contact;
  StockContact::Overlap overlap;
};

Found look(const StockContact& touch, const Volume& stock, const Pose& pose) {
  Found out;
  out.overlap = touch.add(stock, pose, kStiffness, out.contact);
  return out;
}

Pose leaning(double x, double y, double z, double tilt, double turn) {
  return {{x, y, z}, {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)}};
}

void expect_as_dense(const Volume& stock, const Tool& tool, const Pose& pose, const Solid& solid, const Box3& where,
                     double most) {
  const Found found = look(StockContact(tool), stock, pose);
  const Dense truth = dense(tool, pose, solid, where, 0.04);
  const double size = kStiffness * truth.volume;
  ASSERT_GT(size, 0.1);
  EXPECT_NEAR(found.overlap.volume, truth.volume, most * truth.volume);
  EXPECT_LT(glm::length(found.contact.force - truth.force), most * size) << tool.kind();
  EXPECT_LT(glm::length(found.contact.torque - truth.torque), most * size * 6) << tool.kind();
}

TEST(StockContact, OnAFaceAndAnEdgeItIsTheDenseSumForAnyCutterAndGrid) {
  const Tool cutters[] = {cutters::ball(6, 20), cutters::flat(4, 20), cutters::fillet(6, 1, 20)};
  for (const std::string directions : {"z", "x", "xyz"}) {
    if (test::kSanitized && directions == "z") continue;
    const Volume stock = Volume::block({kBox, 0.2, directions});
    for (const Tool& tool : cutters) {
      SCOPED_TRACE(directions + ' ' + tool.kind());
      expect_as_dense(stock, tool, leaning(12.03, 10.07, 9.7, 0, 0), in_block, {{8, 6, 9}, {16, 14, 10}}, 0.05);
      expect_as_dense(stock, tool, leaning(12.03, 10.07, 9.5, 0.4, 1), in_block, {{8, 6, 8}, {16, 14, 10}}, 0.05);
      // The upper edge at x = 24, and the wall.
      expect_as_dense(stock, tool, leaning(25.3, 10, 9.3, -0.3, 0.2), in_block, {{21, 5, 7}, {24, 15, 10}}, 0.06);
      expect_as_dense(stock, tool, {{24.5 + 0.5 * tool.diameter() - 0.9, 10, 2}, kUp}, in_block,
                      {{22, 5, 1}, {24, 15, 10}}, 0.03);
    }
  }
}

TEST(StockContact, AGrooveThatWasJustCutIsFeltAtOnce) {
  // A ball of 8 mm has cut a groove along y at x = 12, 3 mm deep; one of 6 mm touches its side.
  for (const char* directions : {"z", "xyz"}) {
    Volume stock = Volume::block({kBox, 0.2, directions});
    sweep::MoveCarver carver(stock, cutters::ball(8, 20), {.tolerance = 0.002, .deferred = true});
    for (int k = 0; k < 40; ++k) carver.move({{12, 0.5 * k, 7}, kUp}, {{12, 0.5 * (k + 1), 7}, kUp}, 1e-3);
    carver.publish();
    const Solid solid = [](const Vec3& p) {
      const double off = p.x - 12, up = std::min(p.z - 11, 0.0);
      return in_block(p) && off * off + up * up > 16 && (p.z < 11 || std::abs(off) > 4);
    };
    for (const double x : {12.0, 12.6, 13.1}) {
      SCOPED_TRACE(std::string(directions) + ' ' + std::to_string(x));
      expect_as_dense(stock, cutters::ball(6, 20), leaning(x, 10, 6.9, 0.2, 0.5), solid, {{8, 5, 6}, {17, 15, 10}},
                      0.12);
    }
    // Where nothing of the groove is left in the tool, only the columns' corners are felt.
    EXPECT_LT(look(StockContact(cutters::ball(6, 20)), stock, {{12, 10, 8.2}, kUp}).overlap.volume, 1e-9);
  }
}

TEST(StockContact, ItIsContinuousAndEvenAlongASlide) {
  struct Case {
    const char* directions;
    double tilt, most;  // rad; share of the force
  };
  for (const Case& c : {Case{"z", 0, 0.03}, {"xyz", 0, 0.03}, {"z", 0.6, 0.04}, {"xyz", 0.6, 0.04}}) {
    const Volume stock = Volume::block({kBox, 0.2, c.directions});
    const StockContact touch(cutters::ball(6, 20));
    double least = 1e9, largest = 0, jump = 0, before = 0;
    for (int k = 0; k <= test::cases(600); ++k) {
      // 0.2 mm deep on the face, across the rays at an odd angle.
      const Vec3 axis = leaning(0, 0, 0, c.tilt, 0.7).axis, centre(8 + 0.01 * k, 8 + 0.0037 * k, 12.8);
      const double force = glm::length(look(touch, stock, {centre - 3.0 * axis, axis}).contact.force);
      if (k > 0) jump = std::max(jump, std::abs(force - before));
      least = std::min(least, force), largest = std::max(largest, force), before = force;
    }
    EXPECT_LT(largest - least, c.most * largest) << c.directions << ' ' << c.tilt;
    EXPECT_LT(jump, 0.01 * largest);
  }
}

TEST(StockContact, AWallAlongTheRaysIsFeltWithoutSteps) {
  const Volume stock = Volume::block({kBox, 0.2, "z"});
  const Tool tool = cutters::flat(6, 20);
  const StockContact touch(tool);
  double before = 0;
  for (int k = 0; k <= 200; ++k) {
    const double force = -look(touch, stock, {{-3 + 0.004 * k, 10, 0}, kUp}).contact.force.x;
    // No more than the derivative: the chord's length times the wall's height.
    const double chord = 2 * std::sqrt(9 - std::pow(3 - 0.004 * k, 2));
    EXPECT_LE(std::abs(force - before), kStiffness * 0.004 * 10 * (chord + 1.2)) << k;
    before = force;
  }
}

TEST(StockContact, AClosedPathGivesAlmostNoWork) {
  stress::Random random(7);
  for (const char* directions : {"z", "xyz"}) {
    const Volume stock = Volume::block({kBox, 0.2, directions});
    const StockContact touch(cutters::fillet(6, 1, 20));
    for (int round = 0; round < test::cases(6); ++round) {
      const Vec3 middle(23.5 + random.uniform(0, 2), 10, 9.6), a(0.3, 0.2, 0.1), b(-0.1, 0.2, 0.25);
      double work = 0, size = 0;
      Vec3 at = middle + a, force(0);
      for (int k = 0; k <= 2000; ++k) {
        const double t = 2 * kPi * k / 2000;
        const Vec3 now = middle + std::cos(t) * a + std::sin(t) * b;
        const Vec3 push = look(touch, stock, {now, leaning(0, 0, 0, 0.3, 1).axis}).contact.force;
        if (k > 0) {
          const double given = 0.5 * glm::dot(force + push, now - at);
          work += given, size += std::abs(given);
        }
        at = now, force = push;
      }
      EXPECT_LT(std::abs(work), 0.03 * size + 1e-6) << directions << ' ' << round;
    }
  }
}

TEST(StockContact, StiffnessIsTheDerivativeOfTheForceOfASmoothCutter) {
  const Volume stock = Volume::block({kBox, 0.2, "xyz"});
  const StockContact touch(cutters::ball(6, 20));
  const Vec3 axis = leaning(0, 0, 0, 0.3, 1).axis;
  const auto at = [&](double z) { return look(touch, stock, {Vec3(12.03, 10.07, z + 3) - 3.0 * axis, axis}); };
  const double h = 1e-3;
  for (const double z : {9.9, 9.7}) {
    const double slope = (at(z - h).contact.force.z - at(z + h).contact.force.z) / (2 * h);
    EXPECT_NEAR(slope, kStiffness * kPi * (6 - 2 * (10 - z)) * (10 - z), 0.1 * slope);
    EXPECT_NEAR(at(z).contact.stiffness[2][2], slope, 0.1 * slope) << z;
  }
}

TEST(StockContact, FarAwayPosesEmptyStockAndBadPosesGiveFiniteResults) {
  const StockContact touch(cutters::ball(6, 20).with_shank({{20, 3, 40, 3}}));
  const Volume stock = Volume::block({kBox, 0.2, "xyz"}), empty(Volume({kBox, 0.2, "xyz"}));
  for (const Vec3& tip : {Vec3(12, 10, 10.001), Vec3(1e6, 0, 0), Vec3(12, 10, -60), Vec3(-1e9, 1e9, 0)})
    EXPECT_LT(look(touch, stock, {tip, kUp}).overlap.volume, 1e-7);
  EXPECT_EQ(look(touch, empty, {{12, 10, 5}, kUp}).overlap.volume, 0);
  // The shank does not touch, as it does not cut.
  EXPECT_EQ(look(touch, stock, {{12, 10, -20.5}, kUp}).overlap.volume, 0);
  const Found deep = look(StockContact(cutters::ball(20, 20)), stock, {{12, 10, 0}, kUp});
  EXPECT_FALSE(deep.overlap.complete);
  EXPECT_LE(deep.overlap.boxes, StockContact::kMostBoxes);
  EXPECT_THROW(look(touch, stock, {{NAN, 0, 0}, kUp}), std::invalid_argument);
  EXPECT_THROW(look(touch, stock, {{0, 0, 0}, {0, 0, 2}}), std::invalid_argument);
}

TEST(StockContact, AllocatesNothing) {
  const Volume stock = Volume::block({kBox, 0.2, "xyz"});
  const StockContact touch(cutters::ball(6, 20));
  Contact contact;
  touch.add(stock, {{12, 10, 9.5}, kUp}, kStiffness, contact);
  const std::uint64_t before = test::allocations();
  for (int k = 0; k < 50; ++k) touch.add(stock, leaning(12, 10, 9.5, 0.02 * k, 1.0 * k), kStiffness, contact);
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace riffler::collide::stock_contact_test
