#include "riffler/marching/mesher.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "marching/corner_normals.hpp"
#include "marching/facets.hpp"
#include "marching/first_hit.hpp"
#include "marching/mesh_state.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/marching/to_mesh.hpp"

namespace riffler::marching {

namespace {

bool lacks_facets(const MeshState& state, std::size_t brick) {
  const ActiveBrick* const active = state.bricks.active(brick);
  return active && active->edges() > 0 && !state.facets[brick];
}

void prepare(MeshState& state, std::size_t brick) {
  state.facets[brick] = std::make_shared<const Facets>(state.surface, *state.bricks.active(brick));
}

void check_tolerance(double tolerance) {
  if (!(tolerance >= 0 && std::isfinite(tolerance)))
    throw std::invalid_argument("tolerance must be finite and not negative, not " + std::to_string(tolerance) +
                                " mm; 0 keeps all triangles");
}

/// Whether a tolerance is at least one step of the lattice on which vertices lie.
bool is_usable(double tolerance, const Lattice& lattice) {
  return tolerance >= lattice.step();
}

}  // namespace

Mesher::Mesher(const Volume& volume, const Progress& progress)
    : state_(std::make_unique<MeshState>(volume, true, progress)) {}
Mesher::Mesher(const Volume& volume, double tolerance, const Progress& progress) {
  check_tolerance(tolerance);
  state_ = std::make_unique<MeshState>(volume, true, base::part(progress, 0, 0.4));
  if (is_usable(tolerance, state_->lattice)) state_->simplify(tolerance, base::part(progress, 0.4, 1));
  base::report(progress, 1);
}
Mesher::~Mesher() = default;
Mesher::Mesher(Mesher&&) noexcept = default;
Mesher& Mesher::operator=(Mesher&&) noexcept = default;

std::vector<std::size_t> Mesher::update(const Volume& volume, bool normals) {
  return state_->update(volume, normals);
}

std::vector<std::size_t> Mesher::patches() const {
  state_->check_whole();
  std::vector<std::size_t> out;
  for (const std::size_t n : state_->active_bricks())
    if (state_->triangles(n) > 0) out.push_back(n);
  return out;
}

std::size_t Mesher::triangles() const {
  state_->check_whole();
  std::size_t sum = 0;
  for (const std::size_t n : state_->active_bricks()) sum += state_->triangles(n);
  return sum;
}

std::size_t Mesher::all_triangles() const {
  state_->check_whole();
  std::size_t sum = 0;
  for (const std::size_t n : state_->active_bricks()) sum += 2 * state_->bricks.active(n)->edges();
  return sum;
}

Vec3i Mesher::shape() const {
  return {state_->bricks.count(0), state_->bricks.count(1), state_->bricks.count(2)};
}

MeshPatch Mesher::patch(std::span<const std::size_t> bricks) const {
  state_->check_whole();
  return patch_of(*state_, bricks);
}

base::BulkVector<Vec3f> Mesher::corner_normals(const MeshPatch& patch, double sharp) const {
  state_->check_whole();
  return marching::corner_normals(*state_, patch, sharp);
}

Mesh Mesher::mesh() const {
  state_->check_whole();
  return state_->compact();
}

std::optional<SurfaceHit> Mesher::pick(const Vec3& origin, const Vec3& direction, PickStats& stats) {
  state_->check_whole();
  const auto facets = [&](std::size_t n) {
    if (lacks_facets(*state_, n)) prepare(*state_, n), ++stats.bricks_prepared;
    return state_->facets[n].get();
  };
  return first_hit(state_->lattice, origin, direction, facets, stats);
}

FrozenSurface Mesher::freeze(PickStats& stats) {
  state_->check_whole();
  std::vector<std::size_t> missing;
  for (std::size_t n = 0; n < state_->bricks.size(); ++n)
    if (lacks_facets(*state_, n)) missing.push_back(n);
  base::parallel_for(missing.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) prepare(*state_, missing[n]);
  });
  stats.bricks_prepared += missing.size();
  return {state_->lattice, state_->facets};
}

Mesh to_mesh(const Volume& volume, const Progress& progress) {
  return MeshState(volume, false, progress).take();
}

Mesh to_mesh(const Volume& volume, double tolerance, const Progress& progress, std::size_t* all) {
  check_tolerance(tolerance);
  const bool usable = is_usable(tolerance, Lattice(volume));
  MeshState state(volume, false, base::part(progress, 0, 0.6), usable);
  if (all) *all = state.surface.mesh.triangles.size();
  if (!usable) return state.take();
  state.simplify(tolerance, base::part(progress, 0.6, 1));
  return state.compact();
}

}  // namespace riffler::marching
