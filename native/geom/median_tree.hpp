// Complete binary trees over items, split at medians: the base of the trees of boxes and of spheres.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "riffler/base/parallel.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::geom {

/// Index of the first item of node `node` on a level, which has 2^level nodes.
inline std::size_t first_item(std::size_t items, std::size_t level, std::size_t node) {
  return (node * items) >> level;
}

/// Axis of the longest side of a box: 0, 1 or 2.
inline int longest_side(const Vec3& size) {
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// Sorts item numbers into the order of the tree's leaves. Every node above the last level is split at the median of
/// key(item, axis), with the axis that axis(begin, end) returns for its items. Item numbers break ties, so each node
/// holds the same items for any nth_element and any number of threads; the order inside a node may differ.
template <class Index, class Axis, class Key>
void sort_by_medians(std::vector<Index>& order, std::size_t levels, const Axis& axis, const Key& key) {
  const auto at = [&](std::size_t level, std::size_t node) {
    return order.begin() + static_cast<std::ptrdiff_t>(first_item(order.size(), level, node));
  };
  for (std::size_t level = 0; level < levels; ++level)
    base::parallel_for(std::size_t{1} << level, 1, [&](std::size_t node, std::size_t) {
      const auto begin = at(level, node), end = at(level, node + 1);
      const int side = axis(begin, end);
      std::nth_element(begin, at(level + 1, 2 * node + 1), end, [&](Index i, Index j) {
        const double x = key(i, side), y = key(j, side);
        return x != y ? x < y : i < j;
      });
    });
}

/// Same, by the items' centres along the longest side of their box.
template <class Index>
void sort_by_medians(std::vector<Index>& order, std::size_t levels, const std::vector<Vec3>& centres) {
  const auto axis = [&](auto begin, auto end) {
    Box3 box;
    for (auto i = begin; i != end; ++i) box.add(centres[static_cast<std::size_t>(*i)]);
    return longest_side(box.size());
  };
  sort_by_medians(order, levels, axis, [&](Index i, int side) { return centres[static_cast<std::size_t>(i)][side]; });
}

/// Boxes of all nodes. Node i has the children 2 i + 1 and 2 i + 2; leaf_box(k) is the box of leaf k.
template <class LeafBox>
std::vector<Box3> boxes_of_tree(std::size_t levels, const LeafBox& leaf_box) {
  const std::size_t leaves = std::size_t{1} << levels;
  std::vector<Box3> boxes(2 * leaves - 1);
  base::parallel_for(leaves, 1 << 12, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) boxes[leaves - 1 + k] = leaf_box(k);
  });
  for (std::size_t i = leaves - 1; i-- > 0;) {
    boxes[i] = boxes[2 * i + 1];
    boxes[i].add(boxes[2 * i + 2]);
  }
  return boxes;
}

}  // namespace riffler::geom
