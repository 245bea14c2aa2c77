// A tree of bounding spheres with eight children per node, in flat arrays for vector lanes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/lanes.hpp"
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

/// A complete tree: group g has the child groups 8 g + 1 … 8 g + 8, and the groups of the last level hold the items.
/// The same for any number of threads.
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
  /// Number of items below a group, and the place of the first.
  std::size_t under(std::size_t g) const;
  std::size_t first_under(std::size_t g) const;
  /// order()[place] = item.
  const std::vector<std::uint32_t>& order() const { return order_; }
  std::size_t nbytes() const { return groups_.size() * sizeof(SphereGroup) + order_.size() * sizeof(std::uint32_t); }

 private:
  /// First place of node `place` of a level; level l has 8^l nodes.
  std::size_t first(std::size_t level, std::size_t place) const { return (place * order_.size()) >> (3 * level); }
  void sort(const Items& items);
  void bound(const Items& items);

  std::size_t levels_ = 0, first_leaf_ = 0;
  std::vector<SphereGroup> groups_;
  std::vector<std::uint32_t> order_;
};

/// The smallest sphere around a triangle, also for one without area.
BoundingSphere round_triangle(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace riffler::collide
