#include "reference/swept_path.hpp"

#include <algorithm>
#include <limits>
#include <memory>

namespace riffler::reference {

namespace {

constexpr double kGap = 1e-10;

}  // namespace

SweptPath::SweptPath(const tool::Profile& profile, std::span<const Pose> poses) {
  const auto cutter = std::make_shared<const CutterDistance>(profile);
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) moves_.emplace_back(cutter, Motion(poses[k], poses[k + 1]));
}

SweptPath::Near SweptPath::near(const Vec3& p, double reach) const {
  std::vector<std::pair<double, const SweptDistance*>> found;
  for (const SweptDistance& move : moves_)
    if (const double bound = move.lower_bound(p); bound < 2 * reach) found.emplace_back(bound, &move);
  std::sort(found.begin(), found.end());  // the nearest first, because they exclude the most
  Near near;
  near.reach_ = reach;
  for (const auto& [bound, move] : found) near.moves_.push_back(move);
  return near;
}

double SweptPath::Near::distance(const Vec3& q) const {
  double best = reach_;
  for (const SweptDistance* move : moves_)
    best = std::min(best, move->bracket(q, kGap, -std::numeric_limits<double>::infinity(), best).upper);
  return best;
}

bool SweptPath::Near::below(const Vec3& q, double distance) const {
  return std::any_of(moves_.begin(), moves_.end(), [&](const SweptDistance* move) {
    return move->bracket(q, kGap, distance, distance).upper < distance;
  });
}

}  // namespace riffler::reference
