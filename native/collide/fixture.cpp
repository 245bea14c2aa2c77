#include "collide/fixture.hpp"

#include <algorithm>
#include <cmath>

namespace riffler {

namespace {

double distance_at(const Assembly& assembly, const Vec3& q) {
  return assembly.outline().nearest(std::sqrt(q.x * q.x + q.y * q.y), q.z).distance;
}

/// Box of the tool in the part's frame: of the discs at both ends of every edge, and of its bulge.
Box3 box_of(const Assembly& assembly, const ToolFrame& frame) {
  Box3 box;
  const Vec3 flat = glm::sqrt(glm::max(Vec3(0), 1.0 - frame.axis * frame.axis));
  const auto add = [&](double radius, double z) {
    const Vec3 centre = frame.tip + z * frame.axis;
    box.add(centre - radius * flat), box.add(centre + radius * flat);
  };
  for (const OutlineEdge& e : assembly.outline().edges()) {
    const double widest = e.centre ? std::max({e.from.x, e.to.x, e.centre->x + e.bulge}) : std::max(e.from.x, e.to.x);
    add(widest, e.from.y), add(widest, e.to.y);
  }
  return box;
}

/// The tool's distance along a line.
struct Along {
  const Assembly& assembly;
  Vec3 p, d;

  double operator()(double s) const { return distance_at(assembly, p + s * d); }
  /// Where it changes its sign between two places with the distances f and g: two steps of the false position.
  double crossing(double s, double f, double t, double g) const {
    for (int step = 0; step < 2; ++step) {
      const double m = s + (t - s) * (f / (f - g)), h = (*this)(m);
      if ((h < 0) == (f < 0))
        s = m, f = h;
      else
        t = m, g = h;
    }
    return f == g ? s : s + (t - s) * (f / (f - g));
  }
};

/// Stretches of dexels, eight at a time.
class Walks {
 public:
  Walks(const Assembly& assembly, const ToolFrame& frame, const Vec3& way, double least)
      : assembly_(assembly), frame_(frame), way_(way), least_(least) {}

  bool full() const { return count_ == kLanes; }
  void add(const Vec3& foot, double low, double high) { all_[count_++] = {foot, low, high, low, 0, 0, false}; }

  /// Calls visit(along, begin, end) for what of each is in the tool. The distance never changes by more than one moves,
  /// so steps of its size miss nothing longer than `least`.
  template <class Visit>
  void run(const Visit& visit) {
    look([](const Walk& w) { return w.low; });
    for (int k = 0; k < count_; ++k) all_[k].f = now_[k], all_[k].begin = all_[k].low, all_[k].inside = now_[k] < 0;
    const auto next = [&](const Walk& w) { return std::min(w.high, w.s + std::max(std::abs(w.f), least_)); };
    for (bool going = true; going;) {
      going = false;
      look(next);
      for (int k = 0; k < count_; ++k)
        if (Walk& w = all_[k]; w.s < w.high) step(w, next(w), now_[k], visit), going = true;
    }
    count_ = 0;
  }

 private:
  struct Walk {
    Vec3 foot;
    double low, high, s, f, begin;
    bool inside;
  };

  template <class Place>
  void look(const Place& place) {
    SphereGroup points;
    for (int k = 0; k < count_; ++k) points.put(k, {all_[k].foot + place(all_[k]) * way_, 0});
    centre_distances(assembly_.lane_edges(), frame_, points, now_);
  }

  template <class Visit>
  void step(Walk& w, double next, double g, const Visit& visit) {
    const Along along{assembly_,
                      frame_.to_tool(w.foot),
                      {glm::dot(way_, frame_.u), glm::dot(way_, frame_.v), glm::dot(way_, frame_.axis)}};
    if ((g < 0) != w.inside) {
      const double cross = along.crossing(w.s, w.f, next, g);
      if (w.inside)
        visit(along, w.begin, cross);
      else
        w.begin = cross;
      w.inside = !w.inside;
    }
    w.s = next, w.f = g;
    if (w.inside && next >= w.high) visit(along, w.begin, w.high);
  }

  const Assembly& assembly_;
  const ToolFrame& frame_;
  Vec3 way_;
  double least_, now_[kLanes];
  int count_ = 0;
  Walk all_[kLanes];
};

}  // namespace

Fixture::Fixture(const Volume& volume, const Mesh& mesh) : volume_(volume), surface_(mesh), sides_(mesh, true) {
  const Box3 box = bounds(mesh);
  whole_ = {0.5 * (box.lower + box.upper), 0.5 * glm::length(box.size())};
}

bool Fixture::holds(const Vec3& p) const {
  const Closest::Hit hit = sides_(p);
  return sides_.signed_distance(p, hit) < 0;
}

bool Fixture::near(const Assembly& assembly, const ToolFrame& frame, double distance) const {
  return distance_at(assembly, frame.to_tool(whole_.centre)) - whole_.radius < distance;
}

void Fixture::add_dexel(const Assembly& assembly, const ToolFrame& frame, const Vec3& middle, double length,
                        double stiffness, Contact& contact) const {
  const Part part = assembly.part_at(middle.z);
  double low = 0, high = 0;
  for (const Assembly::Stretch& s : assembly.stretches())
    if (s.part == part) low = s.low, high = s.high;
  const Vec3 towards = Vec3(0, 0, 0.5 * (low + high)) - middle, at = frame.turned(middle);
  contact.points.push_back(frame.tip + at), contact.touches.push_back(Touch::Fixture);
  const double away = glm::length(towards), pitch = volume_.frame().pitch;
  if (away == 0) return;
  const Vec3 force = frame.turned(stiffness * length * pitch * pitch / away * towards);
  // The volume in the tool grows with the first to about the third power of the depth: the second stands for all.
  contact.push(at, force, 0.5 * std::max(contact.depth, 1e-2 * pitch));
}

void Fixture::add_force(const Assembly& assembly, const ToolFrame& frame, double stiffness, Deadline& deadline,
                        Contact& contact, Counts& counts) const {
  const Grid& grid = volume_.reference();
  const Box3 box = to_local(grid.axis(), box_of(assembly, frame));
  const double h = grid.pitch();
  const auto index = [&](double x, double lower, int n) {
    return std::clamp(std::floor((x - lower) / h), 0.0, n - 1.0);
  };
  const int i0 = static_cast<int>(index(box.lower.x, grid.box().lower.x, grid.nu()));
  const int i1 = static_cast<int>(index(box.upper.x, grid.box().lower.x, grid.nu()));
  const int j0 = static_cast<int>(index(box.lower.y, grid.box().lower.y, grid.nv()));
  const int j1 = static_cast<int>(index(box.upper.y, grid.box().lower.y, grid.nv()));
  Walks walks(assembly, frame, to_world(grid.axis(), {0, 0, 1}), 1e-2 * h);
  int step = 1;
  const auto flush = [&] {
    walks.run([&](const Along& along, double begin, double end) {
      add_dexel(assembly, frame, along.p + 0.5 * (begin + end) * along.d, end - begin, step * stiffness, contact);
    });
  };
  for (int i = i0; i <= i1; i += step) {
    step = deadline.passed() ? 4 : 1;
    for (int j = j0; j <= j1; ++j) {
      ++counts.dexels;
      for (const Span& s : grid.ray(i, j)) {
        // What of it can be in the tool.
        const double low = std::max(s.near, box.lower.z), high = std::min(s.far, box.upper.z);
        if (!(low < high)) continue;
        walks.add(to_world(grid.axis(), {grid.u(i), grid.v(j), 0}), low, high);
        if (walks.full()) flush();
      }
    }
    flush();
  }
}

}  // namespace riffler
