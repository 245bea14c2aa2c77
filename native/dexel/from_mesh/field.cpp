#include "dexel/from_mesh/field.hpp"

#include <algorithm>
#include <cmath>

#include "geom/math.hpp"

namespace riffler::dexel {

void Field::fill(const BoundaryPieces& pieces, const Surroundings& around) {
  around_ = &around, rays_ = 0;
  path_.clear();
  const auto add = [&](const Vec3& p, bool joined, bool finite) {
    path_.push_back({p.x, p.y, p.z, joined, finite, false, 0, 0, 0});
  };
  // For the second derivatives of a half-line see field_points.cpp.
  const double distance = (Surroundings::kFar - 1) * around.radius, endless = 1 / (kPi * distance * distance);
  for_each_chain(pieces, around.near, [&](const Chain& chain) {
    const Vec3& front = pieces.edges(pieces[around.near[chain.begin]]).front().a;
    const Vec3& back = pieces.edges(pieces[around.near[chain.end - 1]]).back().b;
    if (chain.open_front) add(glm::normalize(front - around.centre), false, false);
    add(front, chain.open_front, true);
    for (std::size_t k = chain.begin; k < chain.end; ++k) {
      const auto ends = pieces.ends(pieces[around.near[k]]);
      path_.insert(path_.end(), ends.begin(), ends.end());
    }
    if (chain.open_back) add(glm::normalize(back - around.centre), true, false);
    rays_ += (chain.open_front + chain.open_back) * endless;
  });
}

}  // namespace riffler::dexel
