#include "bench/scenes.hpp"

#include <cmath>

#include "geom/math.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::bench {

Vec3 centre(int k) {
  const double a = static_cast<double>(k) / kMoves;
  return {10 + 80 * a, 30 + 15 * std::sin(12 * a), 30 - 2 * a};
}

std::vector<Pose> path(double centre_height, bool turning) {
  std::vector<Pose> poses;
  for (int k = 0; k <= kMoves; ++k) {
    const double turn = 4 * kPi * k / kMoves;
    const double x = turning ? 30 * kDegree * std::sin(turn) : 0, y = turning ? 20 * kDegree * std::cos(turn) : 0;
    const Vec3 axis{std::sin(y) * std::cos(x), -std::sin(x), std::cos(y) * std::cos(x)};
    poses.push_back({centre(k) - centre_height * axis, glm::normalize(axis)});
  }
  return poses;
}

std::vector<NamedCutter> named_cutters() {
  const Tool free = cutters::profile({{{1.5, 0}, {}}, {{3, 1.5}, Vec2(1.5, 1.5)}, {{2, 6}, {}}, {{4, 8}, {}}}, 30);
  return {{"ball Ø6", cutters::ball(6, 30), 3},
          {"flat Ø6", cutters::flat(6, 30), 0},
          {"fillet Ø8 r1", cutters::fillet(8, 1, 30), 1},
          {"taper r0.5 Ø8", cutters::taper(0.5, 0.2, 8, 40), 0.5},
          {"cone end Ø8", cutters::cone_end(1.0, 1, 0.4, 8, 40), 1},
          {"free profile", free, 1.5}};
}

}  // namespace riffler::bench
