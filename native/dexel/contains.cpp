#include "riffler/dexel/contains.hpp"

#include <algorithm>
#include <cmath>

#include "riffler/base/parallel.hpp"

namespace riffler::dexel {

namespace {

/// Whether the ray of the cell that contains the point has material at its height.
bool holds(const Grid& grid, const Vec3& p) {
  const Box3& box = grid.box();
  const int i = std::clamp(static_cast<int>((p.x - box.lower.x) / grid.pitch()), 0, grid.nu() - 1),
            j = std::clamp(static_cast<int>((p.y - box.lower.y) / grid.pitch()), 0, grid.nv() - 1);
  const std::span<const Span> ray = grid.ray(i, j);
  const auto next = std::upper_bound(ray.begin(), ray.end(), p.z, [](double z, const Span& s) { return z < s.near; });
  return next != ray.begin() && p.z <= std::prev(next)->far;
}

}  // namespace

std::vector<char> contains(const Volume& volume, std::span<const Vec3> points) {
  const std::size_t needed = volume.grids().size() / 2 + 1;
  const Box3& box = volume.frame().box;
  std::vector<char> out(points.size());
  base::parallel_for(points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3& p = points[k];
      if (!glm::all(glm::greaterThanEqual(p, box.lower)) || !glm::all(glm::lessThanEqual(p, box.upper))) continue;
      std::size_t votes = 0;
      for (const Grid& grid : volume.grids()) votes += holds(grid, to_local(grid.axis(), p));
      out[k] = votes >= needed;
    }
  });
  return out;
}

}  // namespace riffler::dexel
