#include "bench/hull_distance.hpp"

#include "reference/hull_path.hpp"

namespace riffler::bench {

std::vector<double> hull_distances(const Tool& tool, std::span<const RolledPose> poses, double step,
                                   std::span<const Vec3> points) {
  constexpr double kEnough = 1;
  std::vector<std::vector<Vec3>> hulls;
  for (const tool::Hull& hull : tool.hulls()) hulls.emplace_back(hull.vertices.begin(), hull.vertices.end());
  const reference::HullPath distance(hulls, poses, step);
  std::vector<double> out;
  for (const Vec3& p : points) out.push_back(distance(p, kEnough));
  return out;
}

}  // namespace riffler::bench
