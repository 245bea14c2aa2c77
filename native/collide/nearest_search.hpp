// The least signed distance between a tool and surfaces, best first.
#pragma once

#include <span>

#include "collide/deadline.hpp"
#include "collide/surface.hpp"
#include "riffler/base/block_pool.hpp"
#include "riffler/collide/assembly.hpp"
#include "riffler/collide/contact.hpp"

namespace riffler::collide {

/// Nodes and triangles in the order of their lower bounds f(centre) − radius, f being the tool's signed distance, which
/// never changes by more than one moves. So nothing is opened whose bound is above the result.
class NearestSearch {
 public:
  struct Found {
    TriangleSearch::Least least;
    std::size_t surface = 0;  ///< its index
    double low;               ///< no point is nearer; least.distance where not cut short
    double slack;             ///< rounding, and what was not looked for: 1e-10 mm, or as `loose` allows
    double checked;           ///< triangles tested, as a share of those that could matter
  };

  NearestSearch(const Assembly& assembly, const ToolFrame& frame);

  /// Ends at the first place with less than this, which need not be the least.
  void enough(double distance) { enough_ = distance, triangles_.enough(distance); }
  /// A place that is nearer by less than this need not be found, mm: part of the slack.
  void loose(double by) { loose_ = by, triangles_.loose(by); }
  Found operator()(std::span<const Surface* const> surfaces, Deadline deadline, Counts& counts);

 private:
  struct Entry {
    double low;
    std::uint32_t index;  // of a group, or place of a triangle
    std::uint16_t surface;
    enum Kind : std::uint16_t { Triangle, Looked, Group } kind;

    /// Later in the heap; ties are decided by what is there, so the order is always the same.
    bool operator<(const Entry& o) const {
      if (low != o.low) return low > o.low;
      if (kind != o.kind) return kind > o.kind;
      return surface != o.surface ? surface > o.surface : index > o.index;
    }
  };

  void push(const Entry& e);
  void open(const Surface& surface, const Entry& e, Counts& counts);
  void test(const Surface& surface, const Entry& e, Deadline& deadline, Counts& counts);

  const Assembly& assembly_;
  const ToolFrame& frame_;
  TriangleSearch triangles_;
  double limit_ = std::numeric_limits<double>::infinity(), enough_ = -limit_, slack_, loose_ = 0;
  base::BlockVector<Entry> heap_;
  std::size_t best_surface_ = 0;
};

}  // namespace riffler::collide
