#include "collide/fixture.hpp"

#include <algorithm>
#include <cmath>

#include "collide/box_lanes.hpp"
#include "riffler/base/block_pool.hpp"

namespace riffler::collide {

namespace {

double distance_at(const Assembly& assembly, const Vec3& q) {
  return assembly.outline().nearest(std::sqrt(q.x * q.x + q.y * q.y), q.z).distance;
}

/// Sums the force over boxes of material: k times their volume inside the tool, against the tool's normal there or
/// towards the axis point at the centre of cutter, shank or holder.
class FixtureSum {
 public:
  FixtureSum(const Assembly& assembly, const ToolFrame& frame, const MaterialBoxes& boxes, double stiffness,
             bool to_centre, Contact& contact)
      : assembly_(assembly),
        frame_(frame),
        boxes_(boxes),
        stiffness_(stiffness),
        to_centre_(to_centre),
        contact_(contact),
        widest_(0.5 * boxes.spacing() * (1 + 1e-9)) {
    nodes_.reserve(512), pieces_.reserve(512);
    // The tool's surface should be nearly flat across a box.
    for (const Assembly::HeightBand& s : assembly.stretches()) widest_ = std::min(widest_, 0.2 * s.radius);
  }

  void run(Deadline& deadline, Counts& counts) {
    open({0, 1}, deadline, counts);
    while (!nodes_.empty() || !pieces_.empty()) {
      if (!pieces_.empty()) {
        const Piece p = pieces_.back();
        pieces_.pop_back();
        divide(p, deadline, counts);
      } else {
        const Node n = nodes_.back();
        nodes_.pop_back();
        open(n, deadline, counts);
      }
    }
  }

 private:
  struct Node {
    std::size_t group;
    double weight;
  };
  struct Piece {
    Vec3 middle, half;
    double volume, weight;
  };
  /// Sums over the boxes of one group.
  struct Push {
    double volume = 0, area = 0;            // mm³ inside the tool, mm² of its surface in the material
    Vec3 middle{0}, outward{0}, normal{0};  // weighted by volume: place, the tool's normal; the normal by area

    void add(const Vec3& at, const Vec3& n, double v) { volume += v, middle += v * at, outward += v * n; }
  };

  /// Height of the point on the axis towards which material at height z is pushed: the centre of cutter, shank or
  /// holder. At a border the height blends from one to the other, so that the force has no step there. The blend lies
  /// within the narrower part, so a box cut by the face of the wider part is pushed by that; between equally wide parts
  /// it lies half in each.
  double target(double z) const {
    const std::vector<Assembly::HeightBand>& all = assembly_.stretches();
    const auto middle = [](const Assembly::HeightBand& s) { return 0.5 * (s.low + s.high); };
    const double width = boxes_.spacing();
    double out = middle(all[0]);
    for (std::size_t i = 1; i < all.size(); ++i) {
      const double step = all[i].bottom - all[i - 1].top, at = all[i].low - (step > 0) * width + (step < 0) * width;
      out += std::clamp((z - at) / width + 0.5, 0.0, 1.0) * (middle(all[i]) - middle(all[i - 1]));
    }
    return out;
  }

  /// Weight, 0 to 1, with which the material of a node entirely inside the tool pushes as one point; with the remaining
  /// weight it is processed box by box.
  double together(const BoundingSphere& s, double distance) const {
    const double room = -distance - s.radius;  // from the sphere to the tool's surface
    if (!(room > 0) || s.radius == 0) return room > 0;
    const Vec3 p = frame_.to_tool(s.centre);
    double least = room;  // in radii: the smaller of that room and the distance to a change of direction
    for (const Assembly::HeightBand& st : assembly_.stretches())
      if (st.low > 0) least = std::min(least, std::abs(p.z - st.low) - s.radius - 1.5 * boxes_.spacing());
    const double far = glm::length(p - Vec3(0, 0, target(p.z)));
    return std::clamp(std::min(least / s.radius, (far / s.radius - 6) / 3), 0.0, 1.0);
  }

  void push(const Push& sum) {
    if (!(sum.volume > 0)) return;
    const Vec3 arm = sum.middle / sum.volume;
    contact_.points.push_back(frame_.tip + arm), contact_.touches.push_back(Touch::Fixture);
    if (!to_centre_) {
      contact_.push(arm, -stiffness_ * sum.outward);
      // When the tool moves by δ, its volume in the material grows by area (normal · δ) and pushes against the normal.
      if (const double normal = glm::length(sum.normal); normal > 0)
        contact_.resist(arm, sum.normal / normal, stiffness_ * sum.area);
      return;
    }
    const Vec3 at = frame_.to_tool(frame_.tip + arm), towards = frame_.turned(Vec3(0, 0, target(at.z)) - at);
    // Exactly at the centre there is no direction.
    const Vec3 way = towards / std::max(glm::length(towards), boxes_.spacing());
    contact_.push(arm, stiffness_ * sum.volume * way);
    // When the tool moves by δ, its volume in the material grows by area (normal · δ) and pushes along the direction d.
    // The exact stiffness −d normalᵀ is not symmetric. Half the sum of the two squares is never less than its symmetric
    // part; the whole sum also covers what deflects the tool sideways. With less, stiff fixtures shake a tool.
    contact_.resist(arm, way, stiffness_ * sum.area);
    if (const double normal = glm::length(sum.normal); normal > 0)
      contact_.resist(arm, sum.normal / normal, stiffness_ * sum.area);
  }

  /// The tool's normal nearest to a place, or zero on the axis and other places without one direction.
  Vec3 outward_at(const Vec3& place) const {
    const Vec3 q = frame_.to_tool(place);
    const double rho = std::sqrt(q.x * q.x + q.y * q.y);
    const tool::Outline::Nearest nearest = assembly_.outline().nearest(rho, q.z);
    const Vec2 away = (nearest.distance < 0 ? 1.0 : -1.0) * (nearest.point - Vec2(rho, q.z));
    const double length = glm::length(away);
    if (!(length > 0) || !(rho > 0)) return Vec3(0);
    return frame_.turned(Vec3(away.x * q.x / rho, away.x * q.y / rho, away.y)) / length;
  }

  void look(const SphereGroup& spheres, const BoxGroup& boxes, double weight, Deadline& deadline, Counts& counts) {
    counts.boxes += base::kLanes;
    BoxShares at;
    box_shares(assembly_.lane_edges(), frame_, spheres, boxes, at);
    const bool late = deadline.passed();
    Push sum;
    for (int k = 0; k < base::kLanes; ++k) {
      if (!(at.distance[k] < spheres.radius[k])) continue;
      const Vec3 middle = spheres.sphere(k).centre, half(boxes.half[0][k], boxes.half[1][k], boxes.half[2][k]);
      double rest = weight;
      if (!late && std::max({half.x, half.y, half.z}) > widest_) {
        rest *= together(spheres.sphere(k), at.distance[k]);
        if (rest < weight) pieces_.push_back({middle, half, boxes.volume[k], weight - rest});
        if (rest == 0) continue;
      }
      const double volume = rest * boxes.volume[k], area = volume * at.rise[k];
      const Vec3 normal(at.normal[0][k], at.normal[1][k], at.normal[2][k]);
      sum.add(middle - frame_.tip, normal, at.share[k] * volume);
      sum.area += area, sum.normal += area * normal;
    }
    push(sum);
  }

  /// Halves a box along every side that is too long.
  void divide(const Piece& p, Deadline& deadline, Counts& counts) {
    SphereGroup spheres;
    BoxGroup boxes;
    Vec3 half = p.half;
    int parts = 1;
    for (int i = 0; i < 3; ++i)
      if (half[i] > widest_) half[i] *= 0.5, parts *= 2;
    for (int k = 0, bit = 1; k < parts; ++k, bit = 1) {
      Vec3 middle = p.middle;
      for (int i = 0; i < 3; ++i)
        if (half[i] < p.half[i]) middle[i] += k & bit ? half[i] : -half[i], bit *= 2;
      spheres.put(k, {middle, glm::length(half)});
      for (int i = 0; i < 3; ++i) boxes.half[i][k] = half[i];
      boxes.volume[k] = p.volume / parts;
    }
    look(spheres, boxes, p.weight, deadline, counts);
  }

  void open(const Node& n, Deadline& deadline, Counts& counts) {
    const SphereTree& tree = boxes_.tree();
    const SphereGroup& spheres = tree.group(n.group);
    const BoxGroup& boxes = boxes_.boxes(n.group);
    if (tree.holds_items(n.group)) return look(spheres, boxes, n.weight, deadline, counts);
    double distance[base::kLanes];
    centre_distances(assembly_.lane_edges(), frame_, spheres, distance);
    counts.nodes += base::kLanes;
    const bool late = deadline.passed();
    Push sum;
    for (int k = 0; k < base::kLanes; ++k) {
      const BoundingSphere s = spheres.sphere(k);
      if (!(distance[k] < s.radius)) continue;
      const double whole = late ? std::clamp(0.5 - 0.5 * distance[k] / s.radius, 0.0, 1.0) : together(s, distance[k]);
      if (whole > 0)
        sum.add(s.centre - frame_.tip, to_centre_ ? Vec3(0) : outward_at(s.centre), n.weight * whole * boxes.volume[k]);
      if (!late && whole < 1)
        nodes_.push_back({tree.first_child(n.group) + static_cast<std::size_t>(k), n.weight * (1 - whole)});
    }
    push(sum);
  }

  const Assembly& assembly_;
  const ToolFrame& frame_;
  const MaterialBoxes& boxes_;
  double stiffness_;
  bool to_centre_;
  Contact& contact_;
  double widest_;  // mm: largest half side of a box
  base::BlockVector<Node> nodes_;
  base::BlockVector<Piece> pieces_;
};

}  // namespace

Fixture::Fixture(const Volume& volume, const Mesh& mesh, double spacing)
    : boxes_(volume, spacing), surface_(divided(mesh, 8 * boxes_.spacing())), sides_(mesh, true) {
  const Box3 box = bounds(mesh);
  whole_ = {0.5 * (box.lower + box.upper), 0.5 * glm::length(box.size())};
}

bool Fixture::holds(const Vec3& p) const {
  const mesh::Closest::Hit hit = sides_(p);
  return sides_.signed_distance(p, hit) < 0;
}

bool Fixture::near(const Assembly& assembly, const ToolFrame& frame, double distance) const {
  return distance_at(assembly, frame.to_tool(whole_.centre)) - whole_.radius < distance;
}

void Fixture::add_force(const Assembly& assembly, const ToolFrame& frame, double stiffness, bool to_centre,
                        Deadline& deadline, Contact& contact, Counts& counts) const {
  if (boxes_.size() > 0) FixtureSum(assembly, frame, boxes_, stiffness, to_centre, contact).run(deadline, counts);
}

}  // namespace riffler::collide
