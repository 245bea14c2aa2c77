#include "plan/valley_index.hpp"

#include <algorithm>

#include "base/functions.hpp"

namespace riffler::plan {

void ValleyIndex::add(const Valley& valley) {
  const std::vector<Station>& s = valley.stations;
  const std::size_t n = s.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (i + 1 == n && !valley.closed() && n > 1) break;
    const Segment segment{s[i], s[(i + 1) % n]};
    segments_.add(glm::min(segment.a.centre, segment.b.centre) - Vec3(near_),
                  glm::max(segment.a.centre, segment.b.centre) + Vec3(near_), all_.size());
    all_.push_back(segment);
  }
}

bool ValleyIndex::on(const Station& s, const Segment& segment) const {
  const Vec3 ab = segment.b.centre - segment.a.centre;
  const double length2 = glm::dot(ab, ab);
  const double t = length2 > 0 ? std::clamp(glm::dot(s.centre - segment.a.centre, ab) / length2, 0.0, 1.0) : 0;
  if (glm::length(s.centre - segment.a.centre - t * ab) > near_) return false;
  const double chord = 2 * base::sin(0.5 * turn_);
  const auto same = [&](int side, int other) {
    return std::min(glm::length(s.feet[side].away - segment.a.feet[other].away),
                    glm::length(s.feet[side].away - segment.b.feet[other].away)) < chord;
  };
  return (same(0, 0) && same(1, 1)) || (same(0, 1) && same(1, 0));
}

bool ValleyIndex::covers(const Station& station) const {
  bool found = false;
  segments_.look(station.centre, station.centre, [&](std::size_t i) { found = found || on(station, all_[i]); });
  return found;
}

bool ValleyIndex::covers(const Valley& valley) const {
  std::size_t covered = 0;
  for (const Station& s : valley.stations) covered += covers(s) ? 1 : 0;
  return 2 * covered > valley.stations.size();
}

}  // namespace riffler::plan
