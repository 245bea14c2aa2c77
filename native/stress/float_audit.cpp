#include "stress/float_audit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace riffler::stress {

Mesh weld(const Mesh& mesh, FloatAudit& audit) {
  using Key = std::array<float, 3>;
  std::vector<std::pair<Key, int>> order(mesh.vertices.size());
  for (std::size_t n = 0; n < order.size(); ++n) {
    const Vec3& v = mesh.vertices[n];
    Key key{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    if (Vec3(key[0], key[1], key[2]) != v) ++audit.inexact;
    for (float& x : key) x += 0.0F;  // −0 and 0 are one place
    order[n] = {key, static_cast<int>(n)};
  }
  std::vector<int> place(order.size());
  Mesh out;
  std::sort(order.begin(), order.end());
  for (std::size_t n = 0; n < order.size(); ++n) {
    const auto& [key, vertex] = order[n];
    if (n > 0 && order[n - 1].first == key)
      ++audit.merged;
    else
      out.vertices.push_back({key[0], key[1], key[2]});
    place[vertex] = static_cast<int>(out.vertices.size()) - 1;
  }
  for (const Vec3i& t : mesh.triangles) out.triangles.push_back({place[t.x], place[t.y], place[t.z]});
  return out;
}

namespace {

/// Sorts as std::sort does, where the first numbers are from 0 to `end` − 1: these by counting, then each group of
/// equal ones. Returns where the groups begin, and the size at the end.
std::vector<std::size_t> sort_in_groups(std::vector<std::array<int, 3>>& items, std::size_t end) {
  std::vector<std::size_t> begins(end + 1);
  for (const auto& item : items) ++begins[item[0]];
  for (std::size_t n = 0, sum = 0; n <= end; ++n) sum += std::exchange(begins[n], sum);
  std::vector<std::array<int, 3>> sorted(items.size());
  std::vector<std::size_t> next = begins;
  for (const auto& item : items) sorted[next[item[0]]++] = item;
  for (std::size_t n = 0; n < end; ++n) std::sort(sorted.begin() + begins[n], sorted.begin() + begins[n + 1]);
  items = std::move(sorted);
  return begins;
}

}  // namespace

FloatAudit float_audit(const Mesh& mesh, double fold_cosine) {
  FloatAudit result;
  const Mesh m = weld(mesh, result);
  std::vector<std::array<int, 3>> halves;  // from, to, triangle
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
  sort_in_groups(sets, m.vertices.size());
  for (std::size_t n = 1; n < sets.size(); ++n) result.duplicates += sets[n] == sets[n - 1];
  const std::vector<std::size_t> begins = sort_in_groups(halves, m.vertices.size());
  const auto find = [&](int from, int to) {
    const auto group = halves.begin() + begins[from], end = halves.begin() + begins[from + 1];
    return std::ranges::equal_range(group, end, to, {}, [](const auto& half) { return half[1]; });
  };
  for (std::size_t n = 0; n < halves.size(); ++n) {
    const auto [from, to, triangle] = halves[n];
    if (n > 0 && halves[n - 1][0] == from && halves[n - 1][1] == to) ++result.repeated;
    const auto opposite = find(to, from);
    if (opposite.size() != 1) {
      ++result.open;
    } else if (from < to) {
      const Vec3 &a = normals[triangle], &b = normals[opposite.front()[2]];
      if (glm::dot(a, b) < fold_cosine * glm::length(a) * glm::length(b)) ++result.folds;
    }
  }
  if (result.open || result.repeated) return result;  // fans are not defined then
  for (std::size_t v = 0; v < m.vertices.size(); ++v) {
    const std::size_t begin = begins[v], count = begins[v + 1] - begin;
    if (count == 0) {
      ++result.unused;
      continue;
    }
    std::size_t steps = 0;
    const auto* half = &halves[begin];
    do {  // the next triangle around v is across the side that ends in v
      const auto [from, to, triangle] = *half;
      const Vec3i& t = m.triangles[triangle];
      const int c = t.x == from ? 0 : t.y == from ? 1 : 2;
      half = &find(from, t[(c + 2) % 3]).front();
      ++steps;
    } while (half != &halves[begin] && steps <= count);
    if (steps != count) ++result.pinched;
  }
  return result;
}

}  // namespace riffler::stress
