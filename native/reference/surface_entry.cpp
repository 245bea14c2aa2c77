#include "reference/surface_entry.hpp"

#include <algorithm>
#include <queue>

#include "riffler/base/parallel.hpp"

namespace riffler::reference {

namespace {

struct DepthCell {
  double bound;  // of its depth
  Corners corners;
  bool operator<(const DepthCell& o) const { return bound < o.bound; }  // examine the deepest first
};

/// Centre and radius of a ball around the triangle; the centre is on the triangle.
struct Round {
  Vec3 middle;
  double radius;
  explicit Round(const Corners& t)
      : middle((t[0] + t[1] + t[2]) / 3.0),
        radius(std::max({glm::length(t[0] - middle), glm::length(t[1] - middle), glm::length(t[2] - middle)})) {}
};

class Search {
 public:
  Search(const AssemblyDistance& tool, const Pose& pose, double gap) : tool_(tool), pose_(pose), gap_(gap) {}

  void add(const Corners& t, const Round& round) {
    ++looked_;
    if (tool_.beyond(round.middle, round.radius, pose_)) return;
    const double depth = -tool_(round.middle, pose_);
    if (depth > out_.attained) out_.attained = depth, out_.point = round.middle;
    double bound = depth + round.radius;
    if (bound <= out_.attained + gap_) return;
    if (const auto tangent = tool_.tangent_bound(t, round.middle, round.radius, pose_))
      bound = std::min(bound, *tangent);
    if (bound > out_.attained + gap_) cells_.push({bound, t});
  }
  Entry run(std::size_t most) {
    most += looked_;  // in addition to the first examination of every triangle
    while (!cells_.empty() && cells_.top().bound > out_.attained + gap_ && looked_ < most) {
      const auto [a, b, c] = cells_.top().corners;
      cells_.pop();
      const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
      for (const Corners& t : {Corners{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {bc, ca, ab}}) add(t, Round(t));
    }
    // A part left out at any time is no deeper than the depth attained then plus the gap.
    out_.bound = out_.attained + gap_;
    if (!cells_.empty()) out_.bound = std::max(out_.bound, cells_.top().bound);
    return out_;
  }

 private:
  const AssemblyDistance& tool_;
  const Pose& pose_;
  double gap_;
  Entry out_;
  std::priority_queue<DepthCell> cells_;
  std::size_t looked_ = 0;
};

}  // namespace

std::vector<Entry> entries(std::span<const Corners> triangles, const AssemblyDistance& tool,
                           std::span<const Pose> poses, double gap, std::size_t most) {
  std::vector<Round> rounds;
  rounds.reserve(triangles.size());
  for (const Corners& t : triangles) rounds.emplace_back(t);
  std::vector<Entry> out(poses.size());
  base::parallel_for(poses.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Search search(tool, poses[k], gap);
      for (std::size_t t = 0; t < triangles.size(); ++t) search.add(triangles[t], rounds[t]);
      out[k] = search.run(most);
    }
  });
  return out;
}

}  // namespace riffler::reference
