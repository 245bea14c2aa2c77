// The surface around a dab as a small mesh, before and after its displacement.
#pragma once

#include <optional>
#include <vector>

#include "brush/displacement.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::brush {

/// A part of a volume with rays of its own, cut out along cells. Its frame begins at 0, so that the mesh, whose
/// vertices are float32, is as exact far from the origin as near it.
struct Crop {
  Volume volume;
  Vec3 origin;  ///< mm, of the crop's frame in the volume's
  Vec3i first;  ///< cells cut off below, along x, y, z
};

/// The cells of `volume` that `box` (mm) touches, or nothing if there are none.
std::optional<Crop> crop(const Volume& volume, const Box3& box);

/// A closed mesh in the crop's frame. Near the reach, a corner of a triangle has the mean normal of those triangles
/// around its vertex that belong to the same smooth part, so edges stay edges.
class Patch {
 public:
  explicit Patch(const Volume& crop);

  /// Displaces the vertices. Returns whether any moved. For a brush with a plane, fits the plane first.
  bool displace(Displacement& displacement);

  struct State {
    std::vector<Vec3> vertices;
    std::vector<Vec3> corners;  ///< unit normals, 3 per near triangle
  };
  const mesh::Triangles& triangles() const { return triangles_; }
  const State& before() const { return before_; }
  const State& after() const { return after_; }
  /// Triangles near the reach, ascending. `corners` has those of the n-th one from 3 n on.
  const std::vector<std::uint32_t>& near() const { return near_; }
  /// Whether a vertex of the triangle moved.
  bool moved(const Vec3i& triangle) const { return moved(triangle.x) || moved(triangle.y) || moved(triangle.z); }

 private:
  bool moved(int vertex) const { return moved_[static_cast<std::size_t>(vertex)] != 0; }
  void find_near(const Reach& reach);
  void group_corners();
  void fill_corners(State& state) const;
  void fit_plane(Displacement& displacement) const;

  double pitch_;
  mesh::Triangles triangles_;
  State before_, after_;
  std::vector<std::uint8_t> moved_;
  std::vector<std::uint32_t> near_;
  // For each corner of the near triangles, the near triangles, by place in `near_`, whose normals it averages.
  std::vector<std::uint32_t> group_begin_, group_;
};

}  // namespace riffler::brush
