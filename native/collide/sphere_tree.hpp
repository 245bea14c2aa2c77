// A tree of bounding spheres with eight children per node, in flat arrays for vector lanes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "base/lanes.hpp"
#include "riffler/base/bulk.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::collide {

struct BoundingSphere {
  Vec3 centre{0};
  double radius = 0;
};

/// The spheres of the eight children of one node. Unused ones have the radius −∞.
struct alignas(64) SphereGroup {
  double x[base::kLanes], y[base::kLanes], z[base::kLanes], radius[base::kLanes];

  SphereGroup();
  void put(int k, const BoundingSphere& s) {
    x[k] = s.centre.x, y[k] = s.centre.y, z[k] = s.centre.z, radius[k] = s.radius;
  }
  BoundingSphere sphere(int k) const { return {{x[k], y[k], z[k]}, radius[k]}; }
};

/// A complete tree: every group has eight child groups, but the first may have two or four, so that the groups of the
/// last level, which hold the items, are at least half full. The same for any number of threads.
class SphereTree {
 public:
  /// The items of the tree. The functions are called from several threads.
  struct Items {
    std::size_t count;
    std::function<Box3(std::size_t)> box;
    std::function<BoundingSphere(std::size_t)> sphere;      ///< bounding sphere of the item
    std::function<double(std::size_t, const Vec3&)> reach;  ///< largest distance of the item from a point, mm
    /// Centre of the sphere around some items; default: the centre of their box.
    std::function<Vec3(std::span<const std::uint32_t>)> centre = {};
  };
  explicit SphereTree(const Items& items);

  std::size_t size() const { return order_.size(); }
  const SphereGroup& group(std::size_t g) const { return groups_[g]; }
  bool holds_items(std::size_t g) const { return g >= first_leaf_; }
  /// Place of the first item of a leaf group; the items of a group are consecutive.
  std::size_t first_item(std::size_t g) const { return first(levels_, g - first_leaf_); }
  std::size_t groups() const { return groups_.size(); }
  /// The first child group of a group; the others follow it.
  std::size_t first_child(std::size_t g) const { return g == 0 ? 1 : 1 + widest_ + base::kLanes * (g - 1); }
  /// The group above a group that is not the first, and which of its children the group is.
  std::pair<std::size_t, int> parent(std::size_t g) const {
    if (g <= widest_) return {0, static_cast<int>(g - 1)};
    return {1 + (g - 1 - widest_) / base::kLanes, static_cast<int>((g - 1 - widest_) % base::kLanes)};
  }
  /// Number of items below a group, and the place of the first.
  std::size_t under(std::size_t g) const;
  std::size_t first_under(std::size_t g) const;
  /// order()[place] = item.
  const std::vector<std::uint32_t>& order() const { return order_; }
  std::size_t nbytes() const { return groups_.size() * sizeof(SphereGroup) + order_.size() * sizeof(std::uint32_t); }

 private:
  /// First place of node `place` of a level.
  std::size_t first(std::size_t level, std::size_t place) const { return (place * order_.size()) >> halvings(level); }
  /// A level has 2^halvings nodes.
  std::size_t halvings(std::size_t level) const { return level == 0 ? 0 : first_halvings_ + 3 * (level - 1); }
  /// Level and place of a group.
  std::pair<std::size_t, std::size_t> whereabouts(std::size_t g) const;
  void sort(const Items& items);
  void bound(const Items& items);

  std::size_t levels_ = 0, first_leaf_ = 0, first_halvings_ = 0;
  std::size_t widest_ = 0;                // child groups of the first group
  base::BulkVector<SphereGroup> groups_;  // in huge pages: a query jumps in them
  std::vector<std::uint32_t> order_;
};

/// The smallest sphere around a triangle, also for one without area.
BoundingSphere round_triangle(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace riffler::collide
