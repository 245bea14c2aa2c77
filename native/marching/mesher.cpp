#include "marching/mesher.hpp"

#include <algorithm>
#include <stdexcept>

#include "geom/each_once.hpp"
#include "marching/mesh_state.hpp"
#include "marching/to_mesh.hpp"

namespace riffler {

using namespace marching;

Mesher::Mesher(const Volume& volume, const Progress& progress)
    : state_(std::make_unique<MeshState>(volume, true, progress)) {}
Mesher::~Mesher() = default;
Mesher::Mesher(Mesher&&) noexcept = default;
Mesher& Mesher::operator=(Mesher&&) noexcept = default;

std::vector<std::size_t> Mesher::update(const Volume& volume) {
  return state_->update(volume);
}

std::vector<std::size_t> Mesher::patches() const {
  state_->check_whole();
  std::vector<std::size_t> out;
  for (const std::size_t n : state_->active_bricks())
    if (state_->bricks.active(n)->edges() > 0) out.push_back(n);
  return out;
}

std::size_t Mesher::triangles() const {
  state_->check_whole();
  std::size_t quads = 0;
  for (const std::size_t n : state_->active_bricks()) quads += state_->bricks.active(n)->edges();
  return 2 * quads;
}

MeshPatch Mesher::patch(std::size_t brick) const {
  if (brick >= state_->bricks.size())
    throw std::out_of_range("there is no brick " + std::to_string(brick) + ", only " +
                            std::to_string(state_->bricks.size()));
  state_->check_whole();
  MeshPatch out;
  const ActiveBrick* const active = state_->bricks.active(brick);
  if (!active || active->edges() == 0) return out;
  const Mesh& mesh = state_->surface.mesh;
  const auto first = static_cast<std::int32_t>(active->first_vertex),
             end = first + static_cast<std::int32_t>(active->vertices());
  const auto triangles = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(2 * active->first_edge);
  out.own = active->vertices();
  out.triangles.assign(triangles, triangles + static_cast<std::ptrdiff_t>(2 * active->edges()));
  std::vector<std::int32_t> foreign;
  for (const Vec3i& t : out.triangles)
    for (const std::int32_t v : {t.x, t.y, t.z})
      if (v < first || v >= end) foreign.push_back(v);
  each_once(foreign);
  const auto local = [&](std::int32_t v) {
    if (v >= first && v < end) return v - first;
    const auto place = std::lower_bound(foreign.begin(), foreign.end(), v) - foreign.begin();
    return static_cast<std::int32_t>(out.own) + static_cast<std::int32_t>(place);
  };
  for (Vec3i& t : out.triangles) t = {local(t.x), local(t.y), local(t.z)};
  const Axis axis = state_->lattice.axis();
  out.vertices.reserve(out.own + foreign.size());
  for (std::int32_t v = first; v < end; ++v) out.vertices.push_back(Vec3f(to_world(axis, mesh.vertices[v])));
  for (const std::int32_t v : foreign) out.vertices.push_back(Vec3f(to_world(axis, mesh.vertices[v])));
  return out;
}

Mesh Mesher::mesh() const {
  state_->check_whole();
  return state_->compact();
}

Mesh to_mesh(const Volume& volume, const Progress& progress) {
  return MeshState(volume, false, progress).take();
}

}  // namespace riffler
