// A tree of bounding spheres, eight children to a node, as flat arrays for vector lanes.
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

/// Eight spheres side by side, of the children of one node. Those of an empty place have the radius −∞.
struct alignas(64) SphereGroup {
  double x[base::kLanes], y[base::kLanes], z[base::kLanes], radius[base::kLanes];

  SphereGroup();
  void put(int k, const BoundingSphere& s) {
    x[k] = s.centre.x, y[k] = s.centre.y, z[k] = s.centre.z, radius[k] = s.radius;
  }
  BoundingSphere sphere(int k) const { return {{x[k], y[k], z[k]}, radius[k]}; }
};

/// Complete: group g has the groups 8 g + 1 … 8 g + 8 below it, and the last level's groups hold the items themselves.
/// The same for any number of threads.
class SphereTree {
 public:
  /// What is put into the tree. All are asked from several threads.
  struct Items {
    std::size_t count;
    std::function<Box3(std::size_t)> box;
    std::function<BoundingSphere(std::size_t)> sphere;      ///< round the item
    std::function<double(std::size_t, const Vec3&)> reach;  ///< greatest distance of the item from a point
    /// Centre for the sphere round some items; without it that of their box.
    std::function<Vec3(std::span<const std::uint32_t>)> centre = {};
  };
  explicit SphereTree(const Items& items);

  std::size_t size() const { return order_.size(); }
  const SphereGroup& group(std::size_t g) const { return groups_[g]; }
  bool holds_items(std::size_t g) const { return g >= first_leaf_; }
  /// Place of the first item of a group that holds items; items of a group are side by side.
  std::size_t first_item(std::size_t g) const { return first(levels_, g - first_leaf_); }
  std::size_t groups() const { return groups_.size(); }
  /// How many items are below a group, and the place of their first.
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

/// The smallest sphere round a triangle, also one without area.
BoundingSphere round_triangle(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace riffler::collide
