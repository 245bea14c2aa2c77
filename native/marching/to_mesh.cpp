#include "marching/to_mesh.hpp"

#include "geom/parallel.hpp"
#include "marching/signs.hpp"
#include "marching/surface.hpp"

namespace riffler {

namespace {

/// Share of the whole call, from the share of one stage.
Progress stage(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [&progress, from, to](double share) { return progress(from + share * (to - from)); };
}

void turn_to_world(Axis axis, Vertices& vertices) {
  if (axis == Axis::Z) return;
  parallel_for(vertices.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) vertices[n] = to_world(axis, vertices[n]);
  });
}

}  // namespace

Mesh to_mesh(const Volume& volume, const Progress& progress) {
  using namespace marching;
  const Lattice lattice(volume);
  Bricks bricks(lattice);
  read_signs(volume, lattice, bricks, stage(progress, 0, 0.2));
  number_bricks(bricks, stage(progress, 0.2, 0.3));
  Surface surface(volume, lattice, bricks);
  mesh_bricks(surface, stage(progress, 0.3, 0.9));
  choose_candidates(surface, stage(progress, 0.9, 0.94));
  unfold(surface, stage(progress, 0.94, 0.98));
  turn_to_world(lattice.axis(), surface.mesh.vertices);
  report(progress, 1);
  return std::move(surface.mesh);
}

}  // namespace riffler
