// Searches for the place and time at which a moving tool comes too near to surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collide/drift.hpp"
#include "collide/lowest_places.hpp"
#include "collide/surface.hpp"
#include "collide/triangle_search.hpp"
#include "riffler/collide/assembly.hpp"
#include "riffler/collide/swept.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::collide {

/// Branch and bound over the part and over time together: what is far from the whole motion is dismissed for the whole
/// motion, and only what the tool passes closely is examined in ever shorter intervals. Over an interval, a point's
/// distance falls by at most its drift along the tangent plane's normal (collide/drift.hpp). Surfaces along which the
/// tool slides, as in finishing, therefore need few intervals. The triangles of a group are examined together: their
/// lowest places at the middle of the interval (collide/lowest_places.hpp), and there the tangent planes with the
/// drift. What stays open is divided in space where its bound is loose even at the middle of the interval, as along
/// needles where the tool changes its shape, and in time where it is not.
class SweptSearch {
 public:
  SweptSearch(const Assembly& assembly, const Motion& motion, double wanted, std::size_t most);

  /// Searches all surfaces, up to the first place closer than the wanted clearance.
  Swept operator()(std::span<const Surface* const> surfaces);

 private:
  struct MoveInterval {
    double from, to;
    ToolFrame frame;  // at the middle of the interval
    Drift drift;
    std::uint32_t half;  // index of the first half interval; 0: not split yet
  };
  struct Entry {
    double low, radius, drifts;  // of its sphere; the last: how much nearer the tool may come in half the interval
    double high;                 // some place of it is no farther at the middle of the interval
    std::uint32_t index;         // of a group, or of pieces
    std::uint32_t stretch;
    std::uint16_t surface;
    std::uint8_t open;  // bit k: triangle k of a group at the lowest level, or piece k, is not dismissed yet
    enum Kind : std::uint8_t { Group, Leaf, Pieces } kind;
    bool operator<(const Entry& o) const { return low > o.low; }  // smallest bound first
  };

  std::uint32_t add_stretch(double from, double to);
  void push(const Entry& e);
  bool halve(const Surface& surface, Entry e);
  bool is_better_halved(const Entry& e) const;
  void look_again(const Surface& surface, Entry& e);
  void open(const Surface& surface, const Entry& e);
  void open_leaf(const Surface& surface, const Entry& e);
  void look_closely(const MoveInterval& s, const Corners* triangles, double enough, LanePlaces& places, double* low);
  void visit(const Entry& e, const LanePlaces& places, unsigned some);
  void dismiss(Entry& e, double* low);
  void open_triangles(const Surface& surface, Entry e, const Corners* corners, double* low);
  void open_pieces(const Surface& surface, const Entry& e);
  Entry in_pieces(const Entry& e, const Corners& triangle, double low);
  void attained(const Entry& e);

  const Assembly& assembly_;
  const Motion& motion_;
  double wanted_;
  std::size_t most_;
  std::vector<MoveInterval> stretches_;
  std::vector<std::array<Corners, base::kLanes>> pieces_;
  std::vector<Entry> heap_;
  TriangleSearch search_;
  Swept out_;
};

}  // namespace riffler::collide
