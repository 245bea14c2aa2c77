// A hand leads the tool along walls as CAD programs write them: long triangles, needles, few large ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "bench/contact_parts.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/tool/cutters.hpp"
#include "session/sculpt_bench.hpp"
#include "support/effort.hpp"

namespace riffler::session::led_along_walls_test {
namespace {

constexpr double kWay = 15, kPress = 1;               // mm along the wall and towards it, from 0.5 mm before it
constexpr double kBegin = 1, kDown = 0.5, kRest = 1;  // s

/// Where the tool begins, half a millimetre off the wall, and the directions towards the wall and along it.
struct Wall {
  const char* part;
  Vec3 start, towards, along;
};

const std::vector<Wall> kWalls{{"bore", {16.5, 0, 10}, {1, 0, 0}, {0, 0, 1}},
                               {"wall", {16.5, 0, 10}, {1, 0, 0}, {0, 0, 1}},
                               {"prism", {23.5, 0, 10}, {-1, 0, 0}, {0, 0, 1}},
                               {"box", {-3.5, 20, 5}, {1, 0, 0}, {0, 0, 1}},
                               {"needles", {20, 10, 2}, {0, 0, -1}, {0, 1, 0}}};

struct Led {
  double off = 0;   ///< mm along the wall between tool and goal
  double jump = 0;  ///< N: largest change of the force on the hand from tick to tick
  double force = 0, depth = 0;
};

Led led(const Wall& wall, const collide::Collider& obstacles, double speed) {
  const Pose home = test::pen_home();
  const auto hand = [&](double t) {
    pen::HandWish wish{.pose = home, .buttons = t > 0.5 * kBegin ? 1U : 0U};
    const double pressed = std::clamp((t - kBegin) / kDown, 0.0, 1.0),
                 gone = std::clamp(speed * (t - kBegin - kDown), 0.0, kWay);
    wish.pose.tip += kPress * pressed * wall.towards + gone * wall.along;
    return wish;
  };
  test::SculptBench bench(hand, test::sculpt_stock(1), cutters::ball(6, 30), {}, nullptr, &obstacles,
                          Pose{wall.start, {0, 0, 1}});
  Led out;
  Vec3 last(0);
  bool first = true;
  bench.run(kBegin + kDown + kWay / speed + kRest, [&](const SculptTick& tick) {
    if (!first) out.jump = std::max(out.jump, glm::length(tick.wrench.force - last));
    last = tick.wrench.force, first = false;
    out.force = std::max(out.force, glm::length(last)), out.depth = std::max(out.depth, tick.depth);
    out.off = std::abs(glm::dot(tick.tool.tip - wall.start, wall.along) - kWay);
  });
  return out;
}

TEST(LedAlongWalls, TheToolArrivesAndTheForceIsContinuous) {
  const int runs = test::kSanitized ? 1 : std::getenv("RIFFLER_LONG") ? 20 : 1;
  for (const Wall& wall : kWalls) {
    const collide::Collider obstacles(bench::contact_mesh(wall.part));
    for (const double speed : {5.0, 20.0, 60.0}) {
      if (test::kSanitized && speed < 60) continue;
      int arrived = 0;
      Led worst;
      for (int run = 0; run < runs; ++run) {
        const Led now = led(wall, obstacles, speed);
        arrived += now.off < 0.5;
        worst = {std::max(worst.off, now.off), std::max(worst.jump, now.jump), std::max(worst.force, now.force),
                 std::max(worst.depth, now.depth)};
      }
      std::printf("%-8s %2.0f mm/s: %2d of %2d arrived, off %.3f mm, force %.3f N, jump %.4f N, depth %.3f mm\n",
                  wall.part, speed, arrived, runs, worst.off, worst.force, worst.jump, worst.depth);
      EXPECT_EQ(arrived, runs) << wall.part << " at " << speed << " mm/s: " << worst.off << " mm off";
      EXPECT_LT(worst.jump, 0.05) << wall.part << " at " << speed << " mm/s";
      EXPECT_GT(worst.force, 0.03) << wall.part << ": the hand feels no wall";
    }
  }
}

}  // namespace
}  // namespace riffler::session::led_along_walls_test
