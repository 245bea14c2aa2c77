#include "marching/to_mesh.hpp"

#include "geom/parallel.hpp"
#include "marching/surface.hpp"

namespace riffler {

namespace {

/// Share of the whole call, from the share of one stage.
Progress stage(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [&progress, from, to](double share) { return progress(from + share * (to - from)); };
}

void turn_to_world(Axis axis, std::vector<Vec3>& vertices) {
  if (axis == Axis::Z) return;
  parallel_for(vertices.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) vertices[n] = to_world(axis, vertices[n]);
  });
}

}  // namespace

Mesh to_mesh(const Volume& volume, const Progress& progress) {
  using namespace marching;
  const Lattice lattice(volume);
  const SignField signs = signs_of(volume, lattice, stage(progress, 0, 0.15));
  const Counts counts(lattice, signs, stage(progress, 0.15, 0.2));
  if (counts.edges() == 0) return {};
  const std::vector<Hit> hits = hits_of(volume, lattice, signs, counts, stage(progress, 0.2, 0.4));
  Surface surface{lattice, signs, counts, hits, FloatGrid(lattice), {}, {}, {}, {}};
  place_vertices(surface, stage(progress, 0.4, 0.7));
  choose_candidates(surface);
  choose_diagonals(surface, stage(progress, 0.7, 0.95));
  unfold(surface);
  turn_to_world(lattice.axis(), surface.mesh.vertices);
  report(progress, 1);
  return std::move(surface.mesh);
}

}  // namespace riffler
