#include "riffler/collide/stock_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collide/box_lanes.hpp"
#include "collide/tool_frame.hpp"
#include "tool/cutter_only.hpp"

namespace riffler::collide {

namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();
constexpr int kMostParts = 4;  // of a cell along u and v

/// Cells along one coordinate of a grid that may meet [low, high].
std::pair<int, int> cells(double low, double high, double lower, double pitch, int n) {
  const auto cell = [&](double s) {
    return static_cast<int>(std::clamp(std::floor((s - lower) / pitch), -2.0, n + 2.0));
  };
  // The last cell may be half a pitch wider.
  return {std::clamp(cell(low) - 1, 0, n), std::clamp(cell(high) + 1, -1, n - 1)};
}

/// Sums the contact over boxes of one grid, eight at a time.
class Boxes {
 public:
  Boxes(const Assembly& cutter, const ToolFrame& frame, double stiffness, Contact& contact,
        StockContact::Overlap& overlap)
      : cutter_(cutter), frame_(frame), stiffness_(stiffness), contact_(contact), overlap_(overlap) {}

  /// `along`: the coordinate of the rays if other grids count as well, otherwise −1.
  void begin(int along) { along_ = along; }

  void put(const Vec3& middle, const Vec3& half) {
    spheres_.put(count_, {middle, glm::length(half)});
    for (int i = 0; i < 3; ++i) boxes_.half[i][count_] = half[i];
    boxes_.volume[count_] = 8 * half.x * half.y * half.z;
    if (++count_ == base::kLanes) flush();
  }

  bool full() const { return overlap_.boxes >= StockContact::kMostBoxes; }

  void flush() {
    if (count_ == 0) return;
    for (int k = count_; k < base::kLanes; ++k) spheres_.put(k, {{0, 0, 0}, kNone});
    BoxShares at;
    box_shares(cutter_.lane_edges(), frame_, spheres_, boxes_, at);
    for (int k = 0; k < count_; ++k) {
      const BoundingSphere sphere = spheres_.sphere(k);
      if (at.distance[k] < sphere.radius) add(sphere.centre - frame_.tip, boxes_.volume[k], at, k);
    }
    overlap_.boxes += static_cast<std::size_t>(std::exchange(count_, 0));
  }

 private:
  void add(const Vec3& arm, double volume, const BoxShares& at, int k) {
    const Vec3 normal(at.normal[0][k], at.normal[1][k], at.normal[2][k]);
    const double weight = (along_ < 0 ? 1 : normal[along_] * normal[along_]) * volume;
    const double inside = weight * at.share[k], area = weight * at.rise[k];
    overlap_.volume += inside, overlap_.area += area;
    if (inside > 0) contact_.push(arm, -stiffness_ * inside * normal);
    if (area > 0) contact_.resist(arm, normal, stiffness_ * area);
  }

  const Assembly& cutter_;
  const ToolFrame& frame_;
  double stiffness_;
  Contact& contact_;
  StockContact::Overlap& overlap_;
  SphereGroup spheres_;
  BoxGroup boxes_;
  int along_ = -1, count_ = 0;
};

/// The rays of one grid next to a cylinder about the tool's axis, as boxes.
class Rays {
 public:
  Rays(const dexel::Grid& grid, const ToolFrame& frame, double radius, double length, double flat)
      : grid_(grid),
        tip_(geom::to_local(grid.axis(), frame.tip)),
        axis_(geom::to_local(grid.axis(), frame.axis)),
        radius_(radius),
        length_(length),
        parts_(std::clamp(static_cast<int>(std::ceil(0.5 * grid.pitch() / flat)), 1, kMostParts)),
        piece_(grid.pitch() / parts_),
        margin_(1.3 * grid.pitch()) {}  // a cell of 1.5 pitches, and a piece, from its middle to a corner

  /// Returns false if there are too many.
  bool give(Boxes& boxes) const {
    const auto reach = [&](int k) {
      const double round = radius_ * std::sqrt(std::max(0.0, 1 - axis_[k] * axis_[k])), end = length_ * axis_[k];
      return Interval{tip_[k] + std::min(0.0, end) - round, tip_[k] + std::max(0.0, end) + round};
    };
    const Interval u = reach(0), v = reach(1), w = reach(2);
    const Box3& box = grid_.box();
    if (w.far < box.lower.z || w.near > box.upper.z) return true;
    const auto [i0, i1] = cells(u.near, u.far, box.lower.x, grid_.pitch(), grid_.nu());
    const auto [j0, j1] = cells(v.near, v.far, box.lower.y, grid_.pitch(), grid_.nv());
    for (int i = i0; i <= i1; ++i)
      for (int j = j0; j <= j1; ++j) {
        const double width_u = grid_.width_u(i), width_v = grid_.width_v(j);
        const Vec2 middle(box.lower.x + i * grid_.pitch() + 0.5 * width_u,
                          box.lower.y + j * grid_.pitch() + 0.5 * width_v);
        const Interval near = stretch(middle);
        if (!near.empty()) give(i, j, middle, near, boxes);
        if (boxes.full()) return false;
      }
    return true;
  }

 private:
  /// Coordinates along the ray at which its column may meet the cylinder.
  Interval stretch(const Vec2& middle) const {
    const Vec3 from(middle.x - tip_.x, middle.y - tip_.y, -tip_.z);
    const double rise = axis_.z, height = glm::dot(from, axis_), wide = radius_ + margin_;
    Interval out{grid_.box().lower.z, grid_.box().upper.z};
    // Between the two ends.
    if (std::abs(rise) > 1e-9) {
      const double a = (-margin_ - height) / rise, b = (length_ + margin_ - height) / rise;
      out = out.cut({std::min(a, b), std::max(a, b)});
    } else if (height < -margin_ || height > length_ + margin_) {
      return {};
    }
    // Next to the axis: |from + s w − ((from + s w) · axis) axis|² ≤ wide².
    const double square = 1 - rise * rise, half = from.z - height * rise;
    const double rest = glm::dot(from, from) - height * height - wide * wide;
    if (square < 1e-12) return rest <= 0 ? out : Interval{};
    const double root = half * half - square * rest;
    if (root < 0) return {};
    const double side = std::sqrt(root);
    return out.cut({(-half - side) / square, (-half + side) / square});
  }

  void give(int i, int j, const Vec2& middle, const Interval& near, Boxes& boxes) const {
    const double start = grid_.box().lower.z;
    for (const dexel::Span& s : grid_.ray(i, j)) {
      if (s.far <= near.near) continue;
      if (s.near >= near.far) break;
      // The pieces stand still while the tool moves, so that the force is continuous.
      const auto piece = [&](double at) { return std::floor((at - start) / piece_); };
      const double last = piece(std::min(s.far, near.far));
      for (double k = piece(std::max(s.near, near.near)); k <= last && !boxes.full(); ++k) {
        const double from = std::max(s.near, start + k * piece_), to = std::min(s.far, start + (k + 1) * piece_);
        if (to > from) divide(middle, {0.5 * grid_.width_u(i), 0.5 * grid_.width_v(j)}, from, to, boxes);
      }
    }
  }

  void divide(const Vec2& middle, const Vec2& half, double from, double to, Boxes& boxes) const {
    const Vec3 part(half.x / parts_, half.y / parts_, 0.5 * (to - from));
    const Vec3 size = glm::abs(geom::to_world(grid_.axis(), part));
    for (int a = 0; a < parts_; ++a)
      for (int b = 0; b < parts_; ++b)
        boxes.put(geom::to_world(grid_.axis(), {middle.x + (2 * a + 1 - parts_) * part.x,
                                                middle.y + (2 * b + 1 - parts_) * part.y, 0.5 * (from + to)}),
                  size);
  }

  const dexel::Grid& grid_;
  Vec3 tip_, axis_;  // in the grid's cyclic frame
  double radius_, length_;
  int parts_;     // of a cell along u and v
  double piece_;  // mm along the rays
  double margin_;
};

}  // namespace

StockContact::StockContact(const Tool& tool)
    : cutter_(tool::cutter_only(tool)),
      radius_(cutter_.max_radius()),
      length_(tool.length()),
      flat_(std::numeric_limits<double>::infinity()) {
  for (const Assembly::HeightBand& band : cutter_.stretches()) flat_ = std::min(flat_, 0.2 * band.radius);
}

StockContact::Overlap StockContact::add(const Volume& stock, const Pose& pose, double stiffness,
                                        Contact& contact) const {
  const ToolFrame frame(pose);
  Overlap out;
  Boxes boxes(cutter_, frame, stiffness, contact, out);
  for (const dexel::Grid& grid : stock.grids()) {
    boxes.begin(stock.grids().size() > 1 ? static_cast<int>(grid.axis()) : -1);
    out.complete = Rays(grid, frame, radius_, length_, flat_).give(boxes);
    boxes.flush();
    if (!out.complete) break;
  }
  return out;
}

}  // namespace riffler::collide
