#include "sweep/body_groups.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::sweep {

namespace {

tool::Frustum shrunk(const tool::Frustum& f, double by) {
  const double ends = std::min(by, (f.z1 - f.z0) / 4), slope = (f.r1 - f.r0) / (f.z1 - f.z0);
  const double side = std::min(by * std::sqrt(1 + slope * slope), std::max(f.r0, f.r1) / 4);
  const auto radius = [&](double z) { return std::max(0.0, f.r0 + slope * (z - f.z0) - side); };
  return {f.z0 + ends, radius(f.z0 + ends), f.z1 - ends, radius(f.z1 - ends)};
}

}  // namespace

std::vector<ConvexGroup> body_groups(const std::vector<tool::Frustum>& pieces, double by) {
  std::vector<ConvexGroup> out;
  for (const tool::Frustum& f : pieces) {
    const tool::Piece piece = by > 0 ? shrunk(f, by) : f;
    out.push_back(convex_groups(std::span(&piece, 1)).front());
  }
  return out;
}

}  // namespace riffler::sweep
