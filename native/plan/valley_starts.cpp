#include "plan/valley_starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

/// Groups of net points: those in one cube on surfaces with similar normals.
struct Groups {
  std::vector<int> of;             // group of each point, -1 for points too deep to start from
  std::vector<std::size_t> first;  // per group, the point nearest to the reachable area; ascending
};

struct Key {
  std::array<int, 6> at;
  std::size_t index;
};

Key key_of(const Unreached& point, std::size_t index, double cube) {
  const Vec3 place = glm::floor(point.point / cube), way = glm::round(2.0 * point.normal);
  const auto small = [](double x) { return static_cast<int>(std::fmod(x, 1e9)); };
  return {{small(place.x), small(place.y), small(place.z), small(way.x), small(way.y), small(way.z)}, index};
}

Groups grouped(const std::vector<Unreached>& points, double cube, double deepest) {
  std::vector<Key> keys;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].depth <= deepest) keys.push_back(key_of(points[i], i, cube));
  std::sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
    if (a.at != b.at) return a.at < b.at;
    const double x = points[a.index].depth, y = points[b.index].depth;
    return x != y ? x < y : a.index < b.index;
  });
  std::vector<std::size_t> head(points.size());
  Groups groups;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i == 0 || keys[i].at != keys[i - 1].at) groups.first.push_back(keys[i].index);
    head[keys[i].index] = groups.first.back();
  }
  std::sort(groups.first.begin(), groups.first.end());
  groups.of.assign(points.size(), -1);
  for (const Key& key : keys) {
    const auto at = std::lower_bound(groups.first.begin(), groups.first.end(), head[key.index]);
    groups.of[key.index] = static_cast<int>(at - groups.first.begin());
  }
  return groups;
}

}  // namespace

ValleyStarts valley_starts(const ValleyTracer& tracer, const std::vector<Unreached>& points, double cube,
                           double deepest, const Progress& progress) {
  using Found = ValleyTracer::Found;
  const Groups groups = grouped(points, cube, deepest);
  const std::size_t n = groups.first.size();
  std::vector<Station> stations(n);
  std::vector<Found> found(n);
  base::parallel_for(
      n, 16,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) found[i] = tracer.start(points[groups.first[i]], stations[i]);
      },
      progress);
  ValleyStarts starts;
  starts.pressed = n;
  for (std::size_t i = 0; i < n; ++i) {
    if (found[i] == Found::Valley) starts.stations.push_back(stations[i]);
    starts.stuck += found[i] == Found::NoSeat ? 1 : 0;
    starts.faceting += found[i] == Found::TooFlat ? 1 : 0;
    starts.edges += found[i] == Found::NoFace ? 1 : 0;
  }
  starts.is_rest.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    starts.is_rest[i] = groups.of[i] < 0 || found[groups.of[i]] != Found::TooFlat;
  return starts;
}

}  // namespace riffler::plan
