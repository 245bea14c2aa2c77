// A hand leads the tool along walls as CAD programs write them: long triangles, needles, few large ones, and parts of
// the test models.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/contact_parts.hpp"
#include "dexel/shapes.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/mesh/io/io.hpp"
#include "riffler/tool/cutters.hpp"
#include "session/sculpt_bench.hpp"
#include "stress/random.hpp"
#include "support/effort.hpp"

namespace riffler::session::led_along_walls_test {
namespace {

constexpr double kWay = 15, kPress = 1;               // mm along the wall and towards it, from 0.5 mm before it
constexpr double kBegin = 1, kDown = 0.5, kRest = 1;  // s

/// Where the tool begins, half a millimetre off the wall, and the directions towards the wall and along it.
struct Wall {
  std::string part;
  Vec3 start, towards, along;
};

const std::vector<Wall> kWalls{{"bore", {16.5, 0, 10}, {1, 0, 0}, {0, 0, 1}},
                               {"wall", {16.5, 0, 10}, {1, 0, 0}, {0, 0, 1}},
                               {"prism", {23.5, 0, 10}, {-1, 0, 0}, {0, 0, 1}},
                               {"box", {-3.5, 20, 5}, {1, 0, 0}, {0, 0, 1}},
                               {"needles", {20, 10, 2}, {0, 0, -1}, {0, 1, 0}}};

constexpr double kRadius = 3, kLength = 30, kBefore = 0.5, kSize = 100;  // mm; of the tool, before the wall, of a model

bool is_long() {
  return !test::kSanitized && std::getenv("RIFFLER_LONG");
}

/// A model scaled as for `riffler bench haptic`; empty if it is absent.
Mesh model(const std::string& name) {
  const std::filesystem::path file = shapes::model_path(name);
  if (!std::filesystem::exists(file)) return {};
  Mesh mesh = mesh::read_mesh(file.string());
  const Box3 box = mesh::bounds(mesh);
  const double scale = kSize / std::max({box.size().x, box.size().y, box.size().z});
  for (Vec3& v : mesh.vertices) v = scale * (v - box.lower);
  return mesh;
}

/// A stretch of the part along which an upright tool next to it keeps its distance to 0.05 mm.
std::optional<Wall> wall_of(const std::string& name, const Mesh& mesh, const collide::Collider& part) {
  const collide::Assembly tool(cutters::ball(2 * kRadius, kLength));
  stress::Random random(7);
  for (int n = 0; n < 20'000; ++n) {
    const Vec3i& t = mesh.triangles[static_cast<std::size_t>(random.below(static_cast<int>(mesh.triangles.size())))];
    const Vec3 &a = mesh.vertices[t.x], &b = mesh.vertices[t.y], &c = mesh.vertices[t.z];
    const Vec3 across = glm::cross(b - a, c - a);
    if (!(glm::length(across) > 0)) continue;
    const Vec3 normal = glm::normalize(across), along = random.square_to(normal);
    const Vec3 centre = (a + b + c) / 3.0 + (kRadius + kBefore) * normal;
    const Wall wall{name, centre - Vec3(0, 0, kRadius), -normal, along};
    const auto keeps = [&](double s) {
      return std::abs(part.clearance(tool, {wall.start + s * along, {0, 0, 1}}) - kBefore) < 0.05;
    };
    bool kept = true;
    for (double s = -1; kept && s <= kWay + 1; s += 0.5) kept = keeps(s);
    if (kept) return wall;
  }
  return {};
}

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
  test::SculptBench bench(hand, test::sculpt_stock(1), cutters::ball(2 * kRadius, kLength), {}, nullptr, &obstacles,
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

/// Leads the tool along the wall at each of the speeds; `quick`: at the highest only.
void lead(const Wall& wall, const collide::Collider& obstacles, bool quick) {
  const int runs = is_long() ? 20 : 1;
  for (const double speed : {5.0, 20.0, 60.0}) {
    if (quick && speed < 60) continue;
    int arrived = 0;
    Led worst;
    for (int run = 0; run < runs; ++run) {
      const Led now = led(wall, obstacles, speed);
      arrived += now.off < 0.5;
      worst = {std::max(worst.off, now.off), std::max(worst.jump, now.jump), std::max(worst.force, now.force),
               std::max(worst.depth, now.depth)};
    }
    std::printf("%-8s %2.0f mm/s: %2d of %2d arrived, off %.3f mm, force %.3f N, jump %.4f N, depth %.3f mm\n",
                wall.part.c_str(), speed, arrived, runs, worst.off, worst.force, worst.jump, worst.depth);
    EXPECT_EQ(arrived, runs) << wall.part << " at " << speed << " mm/s: " << worst.off << " mm off";
    EXPECT_LT(worst.jump, 0.05) << wall.part << " at " << speed << " mm/s";
    EXPECT_GT(worst.force, 0.03) << wall.part << ": the hand feels no wall";
  }
}

TEST(LedAlongWalls, TheToolArrivesAndTheForceIsContinuous) {
  for (const Wall& wall : kWalls)
    if (!test::kSanitized || wall.part == "bore" || wall.part == "needles")
      lead(wall, collide::Collider(bench::contact_mesh(wall.part)), test::kSanitized);
}

TEST(LedAlongWalls, AlongModelsToo) {
  std::string missing;
  for (const char* name : {"fandisk", "ktoolcav", "ktoolcor", "spider"}) {
    if (test::kSanitized && std::string(name) != "ktoolcav") continue;
    const Mesh mesh = model(name);
    if (mesh.empty()) {
      missing += std::string(missing.empty() ? "" : ", ") + name;
      continue;
    }
    const collide::Collider obstacles(mesh);
    const std::optional<Wall> wall = wall_of(name, mesh, obstacles);
    ASSERT_TRUE(wall) << name << " has no wall of " << kWay << " mm";
    lead(*wall, obstacles, !is_long());
  }
  if (!missing.empty()) GTEST_SKIP() << "not among the models: " << missing;
}

}  // namespace
}  // namespace riffler::session::led_along_walls_test
