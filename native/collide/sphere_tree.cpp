#include "collide/sphere_tree.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "geom/median_tree.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::collide {

namespace {

/// The radius, enlarged so that rounding leaves no corner outside.
double grown(double radius, const Vec3& centre) {
  const double far = std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z)});
  return radius * (1 + 1e-14) + 1e-15 * far;
}

Vec3 middle_of_box(const SphereTree::Items& items, std::span<const std::uint32_t> some) {
  Box3 box;
  for (const std::uint32_t i : some) box.add(items.box(i));
  return 0.5 * (box.lower + box.upper);
}

}  // namespace

SphereGroup::SphereGroup() {
  for (int k = 0; k < base::kLanes; ++k) put(k, {Vec3(0), -std::numeric_limits<double>::infinity()});
}

BoundingSphere round_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  // The sphere over the longest side if it contains the opposite corner, otherwise the circumscribed circle.
  const double ab = glm::dot(b - a, b - a), bc = glm::dot(c - b, c - b), ca = glm::dot(a - c, a - c);
  const auto over = [](const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 centre = 0.5 * (p + q);
    return BoundingSphere{
        centre, std::max(glm::length(p - centre), std::max(glm::length(q - centre), glm::length(r - centre)))};
  };
  const bool first = ab >= bc && ab >= ca, second = !first && bc >= ca;
  const BoundingSphere wide = first ? over(a, b, c) : second ? over(b, c, a) : over(c, a, b);
  if (2 * std::max({ab, bc, ca}) >= ab + bc + ca) return wide;
  const Vec3 n = glm::cross(b - a, c - a);
  const Vec3 centre = a + (glm::cross(n, b - a) * ca + glm::cross(c - a, n) * ab) / (2 * glm::dot(n, n));
  const double radius = std::max({glm::length(a - centre), glm::length(b - centre), glm::length(c - centre)});
  return radius < wide.radius ? BoundingSphere{centre, radius} : wide;
}

SphereTree::SphereTree(const Items& items) : order_(items.count) {
  std::iota(order_.begin(), order_.end(), 0U);
  std::size_t all = 0;  // halvings
  while (items.count > std::size_t{base::kLanes} << all) ++all;
  levels_ = (all + 2) / 3;
  if (levels_ > 0) first_halvings_ = all - 3 * (levels_ - 1), widest_ = std::size_t{1} << first_halvings_;
  for (std::size_t level = 0; level < levels_; ++level) first_leaf_ += std::size_t{1} << halvings(level);
  groups_.resize(first_leaf_ + (std::size_t{1} << all));
  sort(items);
  bound(items);
}

std::pair<std::size_t, std::size_t> SphereTree::whereabouts(std::size_t g) const {
  std::size_t level = 0, begin = 0;
  while (g >= begin + (std::size_t{1} << halvings(level))) begin += std::size_t{1} << halvings(level), ++level;
  return {level, g - begin};
}

std::size_t SphereTree::first_under(std::size_t g) const {
  const auto [level, place] = whereabouts(g);
  return first(level, place);
}

std::size_t SphereTree::under(std::size_t g) const {
  const auto [level, place] = whereabouts(g);
  return first(level, place + 1) - first(level, place);
}

void SphereTree::sort(const Items& items) {
  const std::size_t n = order_.size();
  std::vector<Vec3> centres(n);
  base::parallel_for(n, 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Box3 box = items.box(i);
      centres[i] = 0.5 * (box.lower + box.upper);
    }
  });
  geom::sort_by_medians(order_, halvings(levels_), centres);
}

void SphereTree::bound(const Items& items) {
  const std::size_t leaves = groups_.size() - first_leaf_;
  base::parallel_for(leaves, 1 << 10, [&](std::size_t begin, std::size_t end) {
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      const std::size_t from = first(levels_, leaf), to = first(levels_, leaf + 1);
      std::sort(order_.begin() + static_cast<std::ptrdiff_t>(from), order_.begin() + static_cast<std::ptrdiff_t>(to));
      for (std::size_t i = from; i < to; ++i) {
        BoundingSphere s = items.sphere(order_[i]);
        s.radius = grown(s.radius, s.centre);
        groups_[first_leaf_ + leaf].put(static_cast<int>(i - from), s);
      }
    }
  });
  std::size_t begin = 1;
  for (std::size_t level = 1; level <= levels_; ++level) {
    const std::size_t nodes = std::size_t{1} << halvings(level);
    base::parallel_for(nodes, 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t place = from; place < to; ++place) {
        const std::size_t low = first(level, place);
        const std::span<const std::uint32_t> some(order_.data() + low, first(level, place + 1) - low);
        const Vec3 centre = items.centre ? items.centre(some) : middle_of_box(items, some);
        double radius = 0;
        for (const std::uint32_t i : some) radius = std::max(radius, items.reach(i, centre));
        const auto [above, child] = parent(begin + place);
        groups_[above].put(child, {centre, grown(radius, centre)});
      }
    });
    begin += nodes;
  }
}

}  // namespace riffler::collide
