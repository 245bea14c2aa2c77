// The search for the place and the time at which a moving tool comes too near to surfaces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collide/drift.hpp"
#include "collide/surface.hpp"
#include "collide/triangle_search.hpp"
#include "riffler/collide/assembly.hpp"
#include "riffler/collide/swept.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::collide {

/// Branch and bound over the part and over time at once: what is far from all of the motion is dismissed for all of it,
/// and only what the tool passes close to is looked at in ever shorter stretches. Over a stretch the distance of a
/// point falls by no more than what it drifts along the tangent plane's normal (collide/drift.hpp), so what the tool
/// slides along, as a finishing cutter does, needs few of them.
class SweptSearch {
 public:
  SweptSearch(const Assembly& assembly, const Motion& motion, double wanted, std::size_t most);

  /// Over all surfaces, up to the first place that is nearer than the wanted clearance.
  Swept operator()(std::span<const Surface* const> surfaces);

 private:
  struct MoveInterval {
    double from, to;
    ToolFrame frame;  // in its middle
    Drift drift;
    std::uint32_t half;  // the first of both, or 0: not needed yet
  };
  struct Entry {
    double low, radius, drifts;  // of its sphere; how much nearer the tool may come in half the stretch
    double distance;             // of the sphere's centre in the stretch's middle
    std::uint32_t index;         // of a group, or place of a triangle
    std::uint32_t stretch;
    std::uint16_t surface;
    enum Kind : std::uint16_t { Group, Triangle } kind;
    bool operator<(const Entry& o) const { return low > o.low; }  // the least is first in a heap
  };

  std::uint32_t add_stretch(double from, double to);
  void push(const Entry& e);
  bool halve(const Surface& surface, Entry e);
  bool is_better_halved(const Entry& e) const;
  void look_again(const Surface& surface, Entry& e);
  void open(const Surface& surface, const Entry& e);
  void test(const Surface& surface, const Entry& e);
  void attained(const Entry& e);

  const Assembly& assembly_;
  const Motion& motion_;
  double wanted_;
  std::size_t most_;
  std::vector<MoveInterval> stretches_;
  std::vector<Entry> heap_;
  TriangleSearch search_;
  Swept out_;
};

}  // namespace riffler::collide
