// Ends of the rays of a volume, and whether a volume and its mesh are sound.
#pragma once

#include <gtest/gtest.h>

#include "riffler/dexel/volume.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/mesh/audit.hpp"

namespace riffler::test {

/// f(place, normal) for every end, in the world frame.
template <class F>
void for_each_end(const Volume& volume, const F& f) {
  for (const dexel::Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j) {
        const auto spans = grid.ray(i, j);
        const auto normals = grid.ray_normals(i, j);
        for (std::size_t k = 0; k < spans.size(); ++k) {
          f(to_world(grid.axis(), {grid.u(i), grid.v(j), spans[k].near}), normals[k].near.unpack());
          f(to_world(grid.axis(), {grid.u(i), grid.v(j), spans[k].far}), normals[k].far.unpack());
        }
      }
}

/// Spans in order, apart and within the box; a closed two-manifold mesh without defects.
inline void expect_sound(const Volume& volume) {
  const double least = 1e-9 * volume.frame().pitch;
  for (const dexel::Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j) {
        double last = -1e300;
        for (const dexel::Span& s : grid.ray(i, j)) {
          ASSERT_GE(s.near - last, 0.99 * least);
          ASSERT_GE(s.length(), 0.99 * least);
          ASSERT_GE(s.near, grid.box().lower.z);
          ASSERT_LE(s.far, grid.box().upper.z);
          last = s.far;
        }
      }
  const mesh::Audit a = audit(marching::to_mesh(volume));
  EXPECT_TRUE(a.watertight());
  EXPECT_EQ(a.degenerate + a.duplicates + a.folds, 0U);
}

}  // namespace riffler::test
