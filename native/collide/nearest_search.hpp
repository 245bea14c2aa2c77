// Smallest signed distance between a tool and surfaces, by best-first search.
#pragma once

#include <span>

#include "collide/deadline.hpp"
#include "collide/lowest_places.hpp"
#include "collide/surface.hpp"
#include "riffler/base/block_pool.hpp"
#include "riffler/collide/assembly.hpp"
#include "riffler/collide/contact.hpp"

namespace riffler::collide {

/// Processes nodes and triangles in the order of their lower bounds f(centre) − radius. f is the tool's signed
/// distance, which is 1-Lipschitz, so nothing with a bound above the result is opened.
class NearestSearch {
 public:
  struct Found {
    TriangleSearch::Least least;
    std::size_t surface = 0;  ///< index of the surface
    double low;               ///< lower bound of the distance; equals least.distance if the search was complete
    double slack;             ///< mm: rounding and allowed error, 1e-10 or as set by `loose`
    double checked;           ///< triangles tested, as a fraction of those that could matter
  };

  NearestSearch(const Assembly& assembly, const ToolFrame& frame);

  /// Stops at the first place nearer than `distance` (mm), which need not be the nearest.
  void enough(double distance) { enough_ = distance, triangles_.enough(distance); }
  /// Allows the result to exceed the smallest distance by up to `by` (mm); counted in the slack.
  void loose(double by) { loose_ = by, triangles_.loose(by); }
  /// Searches only for places nearer than `distance` (mm); without one, that is the distance found, at no place.
  void below(double distance) { limit_ = distance, triangles_.below(distance); }
  Found operator()(std::span<const Surface* const> surfaces, Deadline deadline, Counts& counts);

 private:
  struct Entry {
    double low;
    std::uint32_t index;  // index of a group, or place of a triangle
    std::uint16_t surface;
    enum Kind : std::uint16_t { Triangle, Looked, Group } kind;

    /// Orders the heap by bound; ties are broken by content, so that the order is deterministic.
    bool operator<(const Entry& o) const {
      if (low != o.low) return low > o.low;
      if (kind != o.kind) return kind > o.kind;
      return surface != o.surface ? surface > o.surface : index > o.index;
    }
  };

  void push(const Entry& e);
  void open(const Surface& surface, const Entry& e, Counts& counts);
  void look_closely(const Surface& surface, const SphereGroup& spheres, std::size_t first, LanePlaces& places,
                    std::size_t which);
  void find_lowest(const Surface& surface, const SphereGroup& spheres, std::size_t first, double enough,
                   LanePlaces& places, std::size_t which);
  ExactPiece in_tool(const Surface& surface, std::size_t place) const;
  void test(const Surface& surface, const Entry& e, Deadline& deadline, Counts& counts);

  const Assembly& assembly_;
  const ToolFrame& frame_;
  TriangleSearch triangles_;
  double limit_ = std::numeric_limits<double>::infinity(), enough_ = -limit_, slack_, loose_ = 0;
  base::BlockVector<Entry> heap_;
  std::size_t best_surface_ = 0;
};

}  // namespace riffler::collide
