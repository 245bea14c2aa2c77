#include "stress/float_audit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

namespace riffler::stress {

Mesh weld(const Mesh& mesh, FloatAudit& audit) {
  using Key = std::array<float, 3>;
  std::vector<Key> keys(mesh.vertices.size());
  for (std::size_t n = 0; n < keys.size(); ++n) {
    const Vec3& v = mesh.vertices[n];
    keys[n] = {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    if (Vec3(keys[n][0], keys[n][1], keys[n][2]) != v) ++audit.inexact;
    for (float& x : keys[n]) x += 0.0F;  // −0 and 0 are one place
  }
  std::vector<int> order(keys.size()), place(keys.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = static_cast<int>(n);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
  Mesh out;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const Key& key = keys[order[n]];
    if (n > 0 && keys[order[n - 1]] == key)
      ++audit.merged;
    else
      out.vertices.push_back({key[0], key[1], key[2]});
    place[order[n]] = static_cast<int>(out.vertices.size()) - 1;
  }
  for (const Vec3i& t : mesh.triangles) out.triangles.push_back({place[t.x], place[t.y], place[t.z]});
  return out;
}

FloatAudit float_audit(const Mesh& mesh, double fold_cosine) {
  FloatAudit result;
  const Mesh m = weld(mesh, result);
  struct Half {
    int from, to, triangle;
    bool operator<(const Half& o) const { return std::tie(from, to) < std::tie(o.from, o.to); }
  };
  std::vector<Half> halves;
  std::vector<std::array<int, 3>> sets;
  std::vector<Vec3> normals;
  for (std::size_t n = 0; n < m.triangles.size(); ++n) {
    const Vec3i& t = m.triangles[n];
    for (int c = 0; c < 3; ++c) halves.push_back({t[c], t[(c + 1) % 3], static_cast<int>(n)});
    std::array<int, 3> set{t.x, t.y, t.z};
    std::sort(set.begin(), set.end());
    sets.push_back(set);
    const Vec3 normal = glm::cross(m.vertices[t.y] - m.vertices[t.x], m.vertices[t.z] - m.vertices[t.x]);
    normals.push_back(normal);
    if (!(glm::dot(normal, normal) > 0)) ++result.degenerate;
  }
  std::sort(sets.begin(), sets.end());
  for (std::size_t n = 1; n < sets.size(); ++n) result.duplicates += sets[n] == sets[n - 1];
  std::sort(halves.begin(), halves.end());
  const auto find = [&](int from, int to) { return std::equal_range(halves.begin(), halves.end(), Half{from, to, 0}); };
  for (std::size_t n = 0; n < halves.size(); ++n) {
    if (n > 0 && !(halves[n - 1] < halves[n])) ++result.repeated;
    const auto [first, last] = find(halves[n].to, halves[n].from);
    if (last - first != 1) {
      ++result.open;
    } else if (halves[n].from < halves[n].to) {
      const Vec3 &a = normals[halves[n].triangle], &b = normals[first->triangle];
      if (glm::dot(a, b) < fold_cosine * glm::length(a) * glm::length(b)) ++result.folds;
    }
  }
  if (result.open || result.repeated) return result;  // fans are not defined then
  for (std::size_t begin = 0, v = 0; v < m.vertices.size(); ++v) {
    std::size_t end = begin;
    while (end < halves.size() && halves[end].from == static_cast<int>(v)) ++end;
    if (begin == end) {
      ++result.unused;
      continue;
    }
    std::size_t steps = 0;
    const Half* half = &halves[begin];
    do {  // the next triangle around v is across the side that ends in v
      const Vec3i& t = m.triangles[half->triangle];
      const int c = t.x == half->from ? 0 : t.y == half->from ? 1 : 2;
      half = &*find(half->from, t[(c + 2) % 3]).first;
      ++steps;
    } while (half != &halves[begin] && steps <= end - begin);
    if (steps != end - begin) ++result.pinched;
    begin = end;
  }
  return result;
}

}  // namespace riffler::stress
