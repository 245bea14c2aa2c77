#include "collide/force.hpp"

#include <algorithm>
#include <cmath>

#include "collide/outline_lanes.hpp"
#include "riffler/base/block_pool.hpp"

namespace riffler::collide {

namespace {

class ForceSum {
 public:
  ForceSum(const Assembly& assembly, const ToolFrame& frame, const SamplePoints& points, const Stiffness& stiffness,
           double coarse, Contact& contact)
      : assembly_(assembly),
        frame_(frame),
        points_(points),
        stiffness_(stiffness),
        widest_(0.5 * coarse * points.spacing()),
        contact_(contact) {
    for (const Assembly::HeightBand& s : assembly.stretches())
      if (s.part == tool::Part::Cutter) cutter_top_ = s.high;
  }

  void run(Deadline& deadline, Counts& counts) {
    open(0, 1, counts);
    while (!stack_.empty()) {
      const Node n = stack_.back();
      stack_.pop_back();
      if (deadline.passed())
        add(n.parent, n.child, n.distance, n.weight);
      else
        open(base::kLanes * n.parent + 1 + static_cast<std::size_t>(n.child), n.weight, counts);
    }
  }

 private:
  struct Node {
    std::size_t parent;  // its parent group
    int child;
    double distance, weight;
  };

  /// Weight, 0 to 1, of a node as a substitute for its points; in between, both count in part. It depends on the
  /// distance from the cutter, approximated by a cylinder.
  double share(const BoundingSphere& s) const {
    if (s.radius > widest_) return 0;
    const Vec3 p = frame_.to_tool(s.centre);
    const double past = std::max(
        {std::sqrt(p.x * p.x + p.y * p.y) - 0.5 * assembly_.tool().diameter(), p.z - assembly_.tool().length(), -p.z});
    return std::clamp(past / (4 * widest_) - 1, 0.0, 1.0);
  }

  double stiffness_at(double z) const {
    // A ramp as long as the point spacing, so that the force has no step at the end of the cutter.
    const double above = std::clamp((z - cutter_top_) / points_.spacing() + 0.5, 0.0, 1.0);
    return stiffness_.cutter + above * (stiffness_.holder - stiffness_.cutter);
  }

  void add(std::size_t group, int k, double distance, double weight) {
    if (distance >= 0) return;
    const Vec3 point = points_.tree().group(group).sphere(k).centre;
    const double z = glm::dot(point - frame_.tip, frame_.axis);
    const Vec3 force = -distance * weight * stiffness_at(z) * points_.areas(group).area[k];
    contact_.push(point - frame_.tip, force);
    if (const double size = glm::length(force); size > 0)
      contact_.resist(point - frame_.tip, force / size, size / -distance);
    if (weight < 0.5) return;
    contact_.points.push_back(point), contact_.touches.push_back(static_cast<Touch>(assembly_.part_at(z)));
  }

  void open(std::size_t group, double weight, Counts& counts) {
    const SphereTree& tree = points_.tree();
    const SphereGroup& spheres = tree.group(group);
    double distance[base::kLanes];
    centre_distances(assembly_.lane_edges(), frame_, spheres, distance);
    const bool items = tree.holds_items(group);
    (items ? counts.points : counts.nodes) += base::kLanes;
    for (int k = 0; k < base::kLanes; ++k) {
      if (!(distance[k] < spheres.radius[k])) continue;
      if (items) {
        add(group, k, distance[k], weight);
        continue;
      }
      const double coarse = weight * share(spheres.sphere(k));
      if (coarse > 0) add(group, k, distance[k], coarse);
      if (coarse < weight) stack_.push_back({group, k, distance[k], weight - coarse});
    }
  }

  const Assembly& assembly_;
  const ToolFrame& frame_;
  const SamplePoints& points_;
  Stiffness stiffness_;
  double widest_, cutter_top_ = 0;
  Contact& contact_;
  base::BlockVector<Node> stack_;
};

}  // namespace

void add_force(const Assembly& assembly, const ToolFrame& frame, const SamplePoints& points, const Stiffness& stiffness,
               double coarse, Deadline& deadline, Contact& contact, Counts& counts) {
  if (points.size() > 0) ForceSum(assembly, frame, points, stiffness, coarse, contact).run(deadline, counts);
}

}  // namespace riffler::collide
