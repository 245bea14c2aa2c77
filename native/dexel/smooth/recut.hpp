// Rebuilds the rays of a tile after points of the surface have moved.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dexel/smooth/moved_field.hpp"
#include "riffler/dexel/grid.hpp"
#include "riffler/dexel/stats.hpp"

namespace riffler::dexel {

class Recutter {
 public:
  Recutter(const Grid& grid, MovedField& field);

  /// The tile after the move, or the tile itself if nothing changes. Skips rays farther than `radius` from `centre`
  /// (world frame, mm).
  std::shared_ptr<const Tile> run(std::size_t tile, const Vec3& centre, double radius, Stats& stats);

 private:
  struct End {
    double w;
    PackedNormal normal;
    bool operator==(const End&) const = default;
  };
  struct Sample {
    double w, value;
  };

  bool recut(std::span<const Span> ray, std::span<const SpanNormals> normals, std::span<const Interval> changes);
  void follow(const Interval& change, std::size_t first, std::size_t last);
  void place_stops(const Interval& change, std::size_t first, std::size_t last);
  double value(double w);
  void cross(Sample a, Sample b);
  void push(double w, const Vec3& normal);

  const Grid& grid_;
  MovedField& field_;
  double pitch_;
  std::vector<End> old_, ends_;  // of one ray, alternately opening and closing
  std::vector<double> stops_;
  Vec3 normal_{0};  // of the field value evaluated last
  std::uint64_t values_ = 0;
};

}  // namespace riffler::dexel
