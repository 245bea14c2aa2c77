#include "collide/force.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include "collide/force_lanes.hpp"
#include "riffler/base/block_pool.hpp"

namespace riffler::collide {

namespace {

// In units of the cutter's diameter. Across a piece with this radius the depth differs from a plane by 1e-4 of the
// diameter.
constexpr double kSmall = 0.01;
constexpr std::size_t kUsual = 512;  // points of a contact that need no second allocation

class ForceSum {
 public:
  ForceSum(const Assembly& assembly, const ToolFrame& frame, const SamplePoints& points, const Stiffness& stiffness,
           double coarse, bool merge, Contact& contact)
      : assembly_(assembly),
        frame_(frame),
        points_(points),
        ramp_{stiffness, 0, points.spacing()},
        widest_(0.5 * coarse * points.spacing()),
        small_(merge ? kSmall * assembly.tool().diameter() : 0),
        contact_(contact) {
    for (const Assembly::HeightBand& s : assembly.stretches())
      if (s.part == tool::Part::Cutter) ramp_.top = s.high;
  }

  void run(Deadline& deadline, Counts& counts) {
    contact_.points.reserve(kUsual), contact_.touches.reserve(kUsual);
    if (points_.tree().holds_items(0)) {
      take(0, 1);
    } else {
      open(0, 1, counts);
    }
    while (!stack_.empty()) {
      const Node n = stack_.back();
      stack_.pop_back();
      if (deadline.passed())
        add(n.parent, n.child, n.distance, n.weight);
      else
        open(points_.tree().first_child(n.parent) + static_cast<std::size_t>(n.child), n.weight, counts);
    }
    add_items(counts), add_items(counts);
    sums_.add_to(contact_);
  }

 private:
  struct Node {
    std::size_t parent;  // its parent group
    int child;
    double distance, weight;
  };
  struct Found {
    std::array<PointGroup, base::kLanes> groups;
    std::size_t size = 0;
  };

  /// Weight, 0 to 1, of a node as a substitute for its points; in between, both count in part. It depends on the node's
  /// size, and on its distance from the cutter, approximated by a cylinder.
  double share(const BoundingSphere& s) const {
    if (s.radius <= small_) return 1;
    if (s.radius > widest_) return 0;
    const Vec3 p = s.centre - frame_.tip;
    const double z = glm::dot(p, frame_.axis), above = std::max(z - assembly_.tool().length(), -z);
    const double square = glm::dot(p, p) - z * z, radius = 0.5 * assembly_.tool().diameter(), near = 4 * widest_;
    if (above <= near && square <= (radius + near) * (radius + near)) return 0;
    const double past = std::max(std::sqrt(std::max(square, 0.0)) - radius, above);
    return std::clamp(past / near - 1, 0.0, 1.0);
  }

  void add(std::size_t group, int k, double distance, double weight) {
    if (distance >= 0) return;
    const Vec3 point = points_.tree().group(group).sphere(k).centre;
    const double z = glm::dot(point - frame_.tip, frame_.axis);
    const Vec3 force = -distance * weight * ramp_.at(z) * points_.areas(group).area(k);
    contact_.push(point - frame_.tip, force);
    if (const double size = glm::length(force); size > 0)
      contact_.resist(point - frame_.tip, force / size, size / -distance);
    keep(point, z, weight);
  }

  void keep(const Vec3& point, double z, double weight) {
    if (weight < 0.5) return;
    contact_.points.push_back(point), contact_.touches.push_back(static_cast<Touch>(assembly_.part_at(z)));
  }

  /// Adds the items that were found before, while those found since are fetched from memory.
  void add_items(Counts& counts) {
    std::swap(found_, fetched_);
    const std::span<PointGroup> groups(found_->groups.data(), std::exchange(found_->size, 0));
    if (groups.empty()) return;
    add_points(assembly_.lane_edges(), frame_, groups, ramp_, sums_);
    counts.points += groups.size() * base::kLanes;
    for (const PointGroup& g : groups) keep(g);
  }

  void keep(const PointGroup& g) {
    if (g.weight < 0.5) return;
    std::size_t next = contact_.points.size();
    contact_.points.resize(next + static_cast<std::size_t>(std::popcount(g.inside)));
    contact_.touches.resize(contact_.points.size());
    for (unsigned left = g.inside; left != 0; left &= left - 1, ++next) {
      const int k = std::countr_zero(left);
      contact_.points[next] = g.points->sphere(k).centre;
      contact_.touches[next] = static_cast<Touch>(assembly_.part_at(g.z[k]));
    }
  }

  void take(std::size_t group, double weight) {
    PointGroup& out = found_->groups[found_->size++];
    out.points = &points_.tree().group(group), out.areas = &points_.areas(group), out.weight = weight;
  }

  void open(std::size_t group, double weight, Counts& counts) {
    const SphereTree& tree = points_.tree();
    const SphereGroup& spheres = tree.group(group);
    double distance[base::kLanes];
    centre_distances(assembly_.lane_edges(), frame_, spheres, distance);
    counts.nodes += base::kLanes;
    const std::size_t first = tree.first_child(group);
    const bool above_items = tree.holds_items(first);
    for (int k = 0; k < base::kLanes; ++k) {
      if (!(distance[k] < spheres.radius[k])) continue;
      const double coarse = weight * share(spheres.sphere(k));
      if (coarse > 0) add(group, k, distance[k], coarse);
      if (!(coarse < weight)) continue;
      const std::size_t child = first + static_cast<std::size_t>(k);
      points_.fetch(child);
      if (above_items)
        take(child, weight - coarse);
      else
        stack_.push_back({group, k, distance[k], weight - coarse});
    }
    if (above_items) add_items(counts);
  }

  const Assembly& assembly_;
  const ToolFrame& frame_;
  const SamplePoints& points_;
  StiffnessRamp ramp_;
  double widest_, small_;  // mm: largest radius of nodes that may represent their points, and that always do
  ForceSums sums_;
  Contact& contact_;
  base::BlockVector<Node> stack_;
  Found one_, other_, *found_ = &one_, *fetched_ = &other_;  // whose points are added together
};

}  // namespace

void add_force(const Assembly& assembly, const ToolFrame& frame, const SamplePoints& points, const Stiffness& stiffness,
               double coarse, bool merge, Deadline& deadline, Contact& contact, Counts& counts) {
  if (points.size() > 0) ForceSum(assembly, frame, points, stiffness, coarse, merge, contact).run(deadline, counts);
}

}  // namespace riffler::collide
