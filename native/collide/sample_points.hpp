// Points on a surface that represent pieces of it; the contact force is summed over them.
#pragma once

#include <vector>

#include "base/fetch.hpp"
#include "collide/surface.hpp"
#include "riffler/base/bulk.hpp"

namespace riffler::collide {

/// About `spacing` (mm) apart: large triangles are split, small dense ones are merged. Each point represents the area
/// vector of its piece (out of the material) at its centroid, and so does every tree node: a coarser set of points.
class SamplePoints {
 public:
  /// Area vectors of the eight children of a node, mm², by coordinates for vector lanes; and 1 over the size of each, 0
  /// for an area of nothing.
  struct alignas(64) AreaGroup {
    double x[base::kLanes]{}, y[base::kLanes]{}, z[base::kLanes]{}, per_size[base::kLanes]{};

    Vec3 area(int k) const { return {x[k], y[k], z[k]}; }
    void add(int k, const Vec3& a) { x[k] += a.x, y[k] += a.y, z[k] += a.z; }
    void measure();
  };
  /// `spacing` 0 selects the square root of a hundred-thousandth of the area, of an exact surface half of it. Throws
  /// std::invalid_argument for a spacing that is negative, not finite, or so small that it would need more than 50
  /// million points.
  SamplePoints(const Surface& surface, double spacing);

  double spacing() const { return spacing_; }
  std::size_t size() const { return tree_.size(); }
  const SphereTree& tree() const { return tree_; }
  const AreaGroup& areas(std::size_t group) const { return areas_[group]; }
  /// Fetches a group's spheres and areas, which is to be read soon, into the cache.
  void fetch(std::size_t group) const { base::fetch(tree_.group(group)), base::fetch(areas_[group]); }

 private:
  struct Piece {
    Vec3 centroid, area;
    double size;  // mm²: |area| before merging, the weight of the centroid
  };
  SamplePoints(std::vector<Piece> pieces, double spacing);
  static std::vector<Piece> pieces_of(const Surface& surface, double spacing);
  static std::vector<Piece> merged(const std::vector<Piece>& pieces, double spacing);
  static SphereTree tree_over(const std::vector<Piece>& pieces);
  static void gather_exact(const Surface& surface, double spacing, std::vector<Piece>& out);
  static void gather(const Surface& surface, std::size_t group, double spacing, std::vector<Piece>& out);

  double spacing_;
  SphereTree tree_;
  base::BulkVector<AreaGroup> areas_;
};

/// The spacing (mm) that 0 selects; otherwise `spacing`.
double chosen_spacing(const Surface& surface, double spacing);

}  // namespace riffler::collide
