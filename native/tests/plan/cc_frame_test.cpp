#include "riffler/plan/cc_frame.hpp"

#include <gtest/gtest.h>

#include "stress/random.hpp"

namespace riffler::plan::cc_frame_test {
namespace {

void expect_frame(const CcFrame& f, const Vec3& normal) {
  EXPECT_EQ(f.z, normal);
  EXPECT_NEAR(glm::length(f.x), 1, 1e-15);
  EXPECT_NEAR(glm::dot(f.x, f.z), 0, 1e-15);
  EXPECT_LT(glm::length(f.y - glm::cross(f.z, f.x)), 1e-15);
}

TEST(CcFrame, OfAFeedAlongTheNormalOrOfNoneIsStillAFrame) {
  for (const Vec3& n : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, -1, 0), glm::normalize(Vec3(1, 1, 1))})
    for (const Vec3& feed : {Vec3(0), n, -3.0 * n, 1e-300 * n}) expect_frame(cc_frame(feed, n), n);
}

TEST(CcFrame, IsOrthogonalForAnyFeedAcrossTheNormal) {
  const Vec3 n = glm::normalize(Vec3(1, 2, 3));
  expect_frame(cc_frame(1e5 * n + Vec3(1e-6, 0, 0), n), n);
  const CcFrame f = cc_frame({2, 0, 5}, {0, 0, 1});
  EXPECT_LT(glm::length(f.x - Vec3(1, 0, 0)), 1e-15);
  EXPECT_LT(glm::length(f.y - Vec3(0, 1, 0)), 1e-15);
}

TEST(CcFrame, LeansForwardAndToTheLeft) {
  const CcFrame f;
  EXPECT_LT(glm::length(axis_of(f, {0, 0}) - Vec3(0, 0, 1)), 1e-15);
  EXPECT_LT(glm::length(axis_of(f, {0.3, 0}) - Vec3(std::sin(0.3), 0, std::cos(0.3))), 1e-15);
  EXPECT_LT(glm::length(axis_of(f, {0, 0.3}) - Vec3(0, std::sin(0.3), std::cos(0.3))), 1e-15);
}

TEST(CcFrame, GivesLeanAndAxisBackFromEachOther) {
  stress::Random random(3);
  for (int n = 0; n < 10000; ++n) {
    const Vec3 normal = random.direction();
    const CcFrame f = cc_frame(random.direction(), normal);
    const Vec3 axis = n % 10 ? random.direction() : n % 20 ? f.y : normal;
    EXPECT_LT(glm::length(axis_of(f, lean_of(f, axis)) - axis), 1e-14);
    const Lean lean{random.uniform(-3.1, 3.1), random.uniform(-1.5, 1.5)}, back = lean_of(f, axis_of(f, lean));
    EXPECT_NEAR(back.inclination, lean.inclination, 1e-12);
    EXPECT_NEAR(back.tilt, lean.tilt, 1e-12);
  }
}

PencilPath corner_path(bool closed) {
  PencilPath p;
  p.radius = 2, p.closed = closed;
  for (int k = 0; k < 4; ++k) {
    const double a = 1.5707963267948966 * k;
    p.centres.emplace_back(10 * std::cos(a), 10 * std::sin(a), 2);
    p.contacts.push_back({Vec3(10 * std::cos(a), 10 * std::sin(a), 0), 12.0 * Vec3(std::cos(a), std::sin(a), 1.0 / 6)});
    p.normals.push_back({Vec3(0, 0, 1), -Vec3(std::cos(a), std::sin(a), 0)});
  }
  return p;
}

TEST(CcFrame, OfAPathHalvesTheWallsAndRunsRoundALoop) {
  const PencilPath loop = corner_path(true);
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 out = glm::normalize(Vec3(loop.centres[k].x, loop.centres[k].y, 0));
    EXPECT_LT(glm::length(feed_at(loop, k) - glm::cross(Vec3(0, 0, 1), out)), 1e-15);
    EXPECT_LT(glm::length(bisector_at(loop, k) - glm::normalize(Vec3(0, 0, 1) - out)), 1e-15);
  }
  EXPECT_LT(glm::length(feed_at(corner_path(false), 0) - glm::normalize(Vec3(-1, 1, 0))), 1e-15);
  PencilPath slot = corner_path(true);
  slot.contacts[0] = {slot.centres[0] + Vec3(2, 0, 0), slot.centres[0] - Vec3(2, 0, 0)};
  EXPECT_NEAR(std::abs(bisector_at(slot, 0).z), 1, 1e-15) << "between facing walls: square to wall and feed";
  PencilPath point;
  point.radius = 1, point.centres = {{0, 0, 0}}, point.contacts = {{Vec3(0, 0, -1), Vec3(0, 0, -1)}};
  point.normals = {{Vec3(0, 0, 1), Vec3(0, 0, 1)}};
  expect_frame(frame_at(point, 0), {0, 0, 1});
}

}  // namespace
}  // namespace riffler::plan::cc_frame_test
