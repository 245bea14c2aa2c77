// The rise of the drop surface over straight moves, and margins, against dense samples and the reference's distance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cutters.hpp"
#include "mesh/shapes.hpp"
#include "riffler/plan/drop.hpp"
#include "riffler/tool/outline.hpp"
#include "stress/random.hpp"

namespace riffler::plan::drop_rise_test {
namespace {

Mesh soup(stress::Random& random, int triangles, double size) {
  Mesh m;
  for (int k = 0; k < triangles; ++k) {
    const Vec3 at(random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-3, 3));
    for (int i = 0; i < 3; ++i)
      m.vertices.push_back(at + Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-1, 1)));
    m.triangles.push_back(Vec3i(3 * k, 3 * k + 1, 3 * k + 2));
  }
  return m;
}

TEST(DropRise, IsTheLargestOfDenseSamples) {
  stress::Random random(7);
  for (const Tool& tool : named_cutters())
    for (const double size : {0.3, 6.0}) {
      const DropCutter drop(soup(random, 60, size), tool);
      for (int n = 0; n < 8; ++n) {
        const Vec3 a(random.uniform(-12, 12), random.uniform(-12, 12), -4),
            b(random.uniform(-12, 12), random.uniform(-12, 12), -2);
        double most = -1;
        for (int k = 0; k <= 2000; ++k) {
          const Vec3 p = glm::mix(a, b, k / 2000.0);
          if (const DropCutter::Landing l = drop(p); l.touches) most = std::max(most, l.height - p.z);
        }
        const DropCutter::Rise found = drop.rise(a, b, -1);
        EXPECT_GE(found.above, most - 2e-7) << tool.name();
        if (found.above > -1) {
          const Vec3 p = glm::mix(a, b, found.at);
          EXPECT_NEAR(drop(p).height - p.z, found.above, 1e-6) << tool.name() << ": the place that it names";
        }
      }
    }
}

TEST(DropRise, FindsANeedleBetweenTwoSamples) {
  Mesh needle = mesh::box_mesh({-10, -10, -1}, {10, 10, 0});
  const int n = static_cast<int>(needle.vertices.size());
  for (const Vec3& v : {Vec3(1.2345, -0.001, 0), Vec3(1.2345, 0.001, 0), Vec3(1.2345, 0, 5)})
    needle.vertices.push_back(v);
  needle.triangles.push_back(Vec3i(n, n + 1, n + 2));
  const DropCutter drop(needle, cutters::ball(0.01, 20));
  EXPECT_NEAR(drop.rise({-9, 0, 0}, {9, 0, 0}, 0.01).above, 5, 1e-5);
  EXPECT_EQ(drop.rise({-9, 1, 0}, {9, 1, 0}, 0.01).above, 0.01) << "no more than asked where it is not met";
}

TEST(DropRise, HeightOnATriangleIsNowhereAboveTheSurface) {
  stress::Random random(9);
  for (const Tool& tool : named_cutters()) {
    const DropCutter drop(soup(random, 40, 4), tool);
    for (int k = 0; k < 200; ++k) {
      const Vec3 p(random.uniform(-8, 8), random.uniform(-8, 8), 0), q = p + Vec3(random.uniform(-1, 1), 0.3, 0);
      const DropCutter::Landing here = drop(p);
      if (!here.touches) continue;
      EXPECT_EQ(drop.height_on(here, p), here.height);
      if (const DropCutter::Landing there = drop(q); there.touches) {
        EXPECT_LE(drop.height_on(here, q), there.height);
      }
    }
  }
}

TEST(DropMargin, OfABallIsALargerBall) {
  stress::Random random(11);
  const Mesh part = soup(random, 60, 4);
  const DropCutter grown(part, cutters::ball(6, 30), {0, 0, 1}, 0.5), larger(part, cutters::ball(7, 30));
  for (int k = 0; k < 300; ++k) {
    const Vec3 p(random.uniform(-12, 12), random.uniform(-12, 12), 0);
    const DropCutter::Landing a = grown(p), b = larger(p);
    ASSERT_EQ(a.touches, b.touches);
    if (a.touches) {
      EXPECT_NEAR(a.height, b.height + 0.5, 1e-9);
    }
  }
}

TEST(DropMargin, KeepsEveryCutterThatFarFromThePart) {
  stress::Random random(12);
  for (const Tool& tool : named_cutters()) {
    const Mesh part = soup(random, 12, 3);
    const DropCutter drop(part, tool, {0, 0, 1}, 0.4);
    const tool::Outline outline(tool);
    for (int k = 0; k < 40; ++k) {
      const Vec3 p(random.uniform(-9, 9), random.uniform(-9, 9), 0);
      const DropCutter::Landing here = drop(p);
      if (!here.touches) continue;
      double least = 1e9;
      const auto look = [&](const Vec3& at) {
        const Vec3 off = at - Vec3(p.x, p.y, here.height);
        least = std::min(least, outline.nearest(std::hypot(off.x, off.y), off.z).distance);
      };
      look(here.point);
      EXPECT_NEAR(least, 0.4, 2e-3) << tool.name() << ": the contact";
      for (const Vec3i& t : part.triangles)
        for (int i = 0; i <= 30; ++i)
          for (int j = 0; i + j <= 30; ++j)
            look((part.vertices[t.x] * double(i) + part.vertices[t.y] * double(j) +
                  part.vertices[t.z] * double(30 - i - j)) /
                 30.0);
      EXPECT_GE(least, 0.4 - 2e-3) << tool.name();
    }
  }
}

}  // namespace
}  // namespace riffler::plan::drop_rise_test
