#include "marching/mesh_state.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <stdexcept>

#include "base/memory.hpp"
#include "base/sort_unique.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::marching {

namespace {

std::vector<std::size_t> without(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  std::vector<std::size_t> out;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

}  // namespace

MeshState::MeshState(const Volume& now, bool room, const Progress& progress, bool hollow)
    : volume(now),
      lattice(volume),
      bricks(lattice),
      surface(volume, lattice, bricks),
      facets(bricks.size()),
      reader_(lattice),
      room_(room) {
  surface.hollow = hollow;
  follow(now);
  build(progress);
}

std::vector<std::size_t> MeshState::active_bricks() const {
  std::vector<std::size_t> out;
  for (std::size_t n = 0; n < bricks.size(); ++n)
    if (bricks.active(n)) out.push_back(n);
  return out;
}

void MeshState::build(const Progress& progress) {
  vertices_ = {}, quads_ = {};
  read_signs(reader_, bricks, base::part(progress, 0, 0.2));
  base::parallel_for(
      bricks.size(), 8,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) bricks.set_active(n, counted(bricks, n));
      },
      base::part(progress, 0.2, 0.3));
  const std::vector<std::size_t> all = active_bricks();
  for (const std::size_t n : all) give_place(*bricks.active(n));
  give_room();
  mesh_bricks(surface, all, base::part(progress, 0.3, 0.9));
  choose_candidates(surface, undecided(surface, all), {}, base::part(progress, 0.9, 0.94));
  Region everywhere;
  unfold(surface, quads_to_look_at(all), everywhere, base::part(progress, 0.94, 1));
  base::report(progress, 1);
}

/// Quads that may have folded, and those around vertices that had a choice.
std::vector<QuadRef> MeshState::quads_to_look_at(const std::vector<std::size_t>& list) {
  std::vector<QuadRef> quads;
  std::vector<Vec3i> cells;
  for (const std::size_t n : list) {
    const ActiveBrick& brick = *bricks.active(n);
    quads.insert(quads.end(), brick.suspects.begin(), brick.suspects.end());
  }
  for (const VertexChoice* s : undecided(surface, list)) cells.push_back(s->at.cell);
  const std::vector<QuadRef> chosen = quads_near(surface, cells, kCandidate);
  quads.insert(quads.end(), chosen.begin(), chosen.end());
  return quads;
}

/// Refuses a mesh that does not fit in the free memory, before anything of it is allocated.
void MeshState::check_memory() const {
  constexpr double kUnchecked = 5e8;  // bytes that are asked for without a look
  const auto more = [](const auto& vector, std::size_t size) {
    return size > vector.size() ? static_cast<double>(size - vector.size()) * sizeof vector[0] : 0.0;
  };
  const double bytes = more(surface.mesh.vertices, vertices_.end()) + more(surface.marks, vertices_.end()) +
                       more(surface.mesh.triangles, 2 * quads_.end());
  if (bytes > kUnchecked)
    base::require_memory(bytes, dexel::available_memory(), "the mesh of this volume", "take a coarser pitch");
}

void MeshState::give_room() {
  if (quads_.end() > std::numeric_limits<std::int32_t>::max() / 2 ||
      vertices_.end() > std::numeric_limits<std::int32_t>::max())
    throw std::invalid_argument("the mesh of this volume would have more than 2^31 triangles; take a coarser pitch");
  check_memory();
  // Growing a vector copies it, which would delay a stroke.
  const auto resize = [&](auto& vector, std::size_t size) {
    if (size <= vector.size()) return;
    if (room_ && size > vector.capacity()) vector.reserve(2 * size + (std::size_t{1} << 18));
    vector.resize(size);
  };
  resize(surface.mesh.vertices, vertices_.end()), resize(surface.marks, vertices_.end());
  resize(surface.mesh.triangles, 2 * quads_.end());
}

Mesh MeshState::take() {
  Mesh mesh = std::move(surface.mesh);
  if (lattice.axis() == Axis::Z) return mesh;
  base::parallel_for(mesh.vertices.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) mesh.vertices[n] = to_world(lattice.axis(), mesh.vertices[n]);
  });
  return mesh;
}

/// The mesh of these triangles, which need not use all vertices: `for_triangles(brick, body)` calls body(triangle).
template <class ForTriangles>
Mesh MeshState::renumbered(const std::vector<std::size_t>& all, const ForTriangles& for_triangles) const {
  // New numbers: first of each brick's vertices and triangles, then of each vertex.
  std::vector<std::size_t> vertex(all.size() + 1, 0), triangle(all.size() + 1, 0);
  base::BulkVector<std::int32_t> number(surface.mesh.vertices.size());
  const auto each = [&](const auto& body) {
    base::parallel_for(all.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) body(n, *bricks.active(all[n]));
    });
  };
  each([&](std::size_t, const ActiveBrick& brick) {
    std::fill_n(number.begin() + static_cast<std::ptrdiff_t>(brick.first_vertex), brick.vertices(), -1);
  });
  // A vertex may have triangles of other bricks only. Bricks that mark the same vertex write the same value.
  each([&](std::size_t n, const ActiveBrick&) {
    for_triangles(all[n], [&](const Vec3i& v) {
      ++triangle[n + 1];
      for (const std::int32_t c : {v.x, v.y, v.z}) std::atomic_ref(number[c]).store(0, std::memory_order_relaxed);
    });
  });
  each([&](std::size_t n, const ActiveBrick& brick) {
    for (std::size_t v = 0; v < brick.vertices(); ++v)
      if (number[brick.first_vertex + v] == 0) ++vertex[n + 1];
  });
  for (std::size_t n = 0; n < all.size(); ++n) vertex[n + 1] += vertex[n], triangle[n + 1] += triangle[n];
  Mesh mesh;
  mesh.vertices.resize(vertex.back()), mesh.triangles.resize(triangle.back());
  each([&](std::size_t n, const ActiveBrick& brick) {
    std::size_t next = vertex[n];
    for (std::size_t v = brick.first_vertex; v < brick.first_vertex + brick.vertices(); ++v) {
      if (number[v] < 0) continue;
      mesh.vertices[next] = to_world(lattice.axis(), surface.mesh.vertices[v]);
      number[v] = static_cast<std::int32_t>(next++);
    }
  });
  each([&](std::size_t n, const ActiveBrick&) {
    std::size_t next = triangle[n];
    for_triangles(all[n], [&](const Vec3i& v) { mesh.triangles[next++] = {number[v.x], number[v.y], number[v.z]}; });
  });
  return mesh;
}

Mesh MeshState::compact() const {
  if (!adaptive) return compact_full();
  return renumbered(active_bricks(), [&](std::size_t n, const auto& body) { adaptive->for_triangles(n, body); });
}

Mesh MeshState::compact_full() const {
  const std::vector<std::size_t> all = active_bricks();
  std::vector<std::size_t> vertex(all.size() + 1, 0), quad(all.size() + 1, 0);
  for (std::size_t n = 0; n < all.size(); ++n) {
    vertex[n + 1] = vertex[n] + bricks.active(all[n])->vertices();
    quad[n + 1] = quad[n] + bricks.active(all[n])->edges();
  }
  Mesh mesh;
  mesh.vertices.resize(vertex.back()), mesh.triangles.resize(2 * quad.back());
  base::BulkVector<std::int32_t> number(surface.mesh.vertices.size());
  base::parallel_for(all.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const ActiveBrick& brick = *bricks.active(all[n]);
      for (std::size_t v = 0; v < brick.vertices(); ++v) {
        number[brick.first_vertex + v] = static_cast<std::int32_t>(vertex[n] + v);
        mesh.vertices[vertex[n] + v] = to_world(lattice.axis(), surface.mesh.vertices[brick.first_vertex + v]);
      }
    }
  });
  base::parallel_for(all.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const ActiveBrick& brick = *bricks.active(all[n]);
      for (std::size_t t = 0; t < 2 * brick.edges(); ++t) {
        const Vec3i& from = surface.mesh.triangles[2 * brick.first_edge + t];
        mesh.triangles[2 * quad[n] + t] = {number[from.x], number[from.y], number[from.z]};
      }
    }
  });
  return mesh;
}

void MeshState::simplify(double tolerance, const Progress& progress) {
  adaptive = std::make_unique<AdaptiveState>(surface, tolerance, room_);
  adaptive->build(active_bricks(), progress);
  base::report(progress, 1);
}

std::size_t MeshState::triangles(std::size_t brick) const {
  if (adaptive) return adaptive->count(brick);
  const ActiveBrick* const active = bricks.active(brick);
  return active ? 2 * active->edges() : 0;
}

// Following a volume.

std::vector<std::size_t> MeshState::update(const Volume& now, bool normals) {
  if (!(now.frame() == volume.frame()))
    throw std::invalid_argument("a mesher follows volumes of one box, pitch and directions");
  std::vector<std::size_t> changed, shaded;
  const bool rebuilt = broken_;
  if (rebuilt) {
    changed = active_bricks();
    facets.assign(bricks.size(), nullptr);
    follow(now);
    build({});
    const std::vector<std::size_t> all = active_bricks();
    changed.insert(changed.end(), all.begin(), all.end());
  } else {
    const Changes changes = changes_between(volume, now, lattice, bricks);
    broken_ = true;  // until the update succeeds
    follow(now);
    if (!changes.empty()) {
      Renewed renewed = mesh_again(changes);
      changed = std::move(renewed.meshed), shaded = std::move(renewed.shaded);
    }
  }
  base::sort_unique(changed);
  for (const std::size_t n : changed) facets[n].reset();
  // The next cells of a change are in `changed`, too: its reach (changes.cpp) covers the triangles around their
  // vertices.
  if (normals) shaded.insert(shaded.end(), changed.begin(), changed.end());
  if (adaptive && rebuilt)
    adaptive->build(active_bricks(), {});
  else if (adaptive)
    changed = adaptive->update(changed);
  broken_ = false;
  if (normals) {
    changed.insert(changed.end(), shaded.begin(), shaded.end());
    base::sort_unique(changed);
  }
  return changed;
}

void MeshState::check_whole() const {
  if (broken_)
    throw std::runtime_error(
        "the last update of this mesher failed half way; update it again before asking for its mesh");
}

MeshState::Renewed MeshState::mesh_again(const Changes& changes) {
  read_signs_again(changes.sign_bricks);
  Renewed out;
  std::vector<std::size_t>& changed = out.meshed;
  std::vector<std::size_t> fresh, pulling;
  std::vector<Vec3i> undone;  // cells whose vertices were pulled and are no longer
  for (const std::size_t n : changes.mesh_bricks) {
    if (bricks.active(n)) changed.push_back(n);
    if (const ActiveBrick* const old = bricks.active(n); old && !old->pulled.empty()) {
      pulling.push_back(n);
      for (const MovedVertex& p : old->pulled) undone.push_back(p.at.cell);
    }
    place_again(n);
    if (bricks.active(n)) changed.push_back(n), fresh.push_back(n);
  }
  give_room();
  mesh_bricks(surface, fresh, {});
  link_bricks(surface, without(around(changes.mesh_bricks, 0, 1), fresh));
  // Nearby vertices that had a choice or were pulled also start again.
  std::vector<BrickSnapshot> unsettled;
  for (const std::size_t n : around(changes.mesh_bricks, -1, 1)) {
    if (changes.meshes[n]) continue;
    BrickSnapshot was = unsettle(n);
    if (was.places.empty()) continue;
    unsettled.push_back(std::move(was));
    fresh.push_back(n);
  }
  base::sort_unique(fresh);
  for (const BrickSnapshot& u : unsettled) undone.insert(undone.end(), u.pulled.begin(), u.pulled.end());
  choose_again(fresh, undone);
  std::vector<std::size_t> others = unfold_again(fresh, undone);
  for (const BrickSnapshot& u : unsettled)
    if (moved(u)) others.push_back(u.brick);
  // The next bricks have quads at vertices that were pulled, or are now.
  others.insert(others.end(), pulling.begin(), pulling.end());
  for (const std::size_t n : changes.mesh_bricks)
    if (bricks.active(n) && !bricks.active(n)->pulled.empty()) others.push_back(n);
  base::sort_unique(others);
  out.shaded = around(others, -1, 1);  // at vertices next to those
  others = around(others, 0, 1);
  changed.insert(changed.end(), others.begin(), others.end());
  return out;
}

void MeshState::follow(const Volume& now) {
  volume = now;
  reader_.follow(volume);
  surface.hits = HitFinder(volume, lattice);
}

void MeshState::read_signs_again(const std::vector<std::size_t>& changed) {
  base::parallel_for(changed.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Vec3i at = bricks.place(changed[n]);
      reader_.read(bricks, at.x, at.y, at.z, at.z);
    }
  });
}

/// Counts a brick's vertices and quads again, and gives it new ranges in the mesh.
void MeshState::place_again(std::size_t n) {
  if (const ActiveBrick* const old = bricks.active(n)) {
    vertices_.give_back(old->first_vertex, old->vertices());
    quads_.give_back(old->first_edge, old->edges());
  }
  bricks.set_active(n, counted(bricks, n));
  if (ActiveBrick* const brick = bricks.active(n)) give_place(*brick);
}

void MeshState::give_place(ActiveBrick& brick) {
  brick.first_edge = quads_.take(brick.edges()), brick.first_vertex = vertices_.take(brick.vertices());
}

/// The active bricks at offsets `from` … `to` along each axis from these; ascending.
std::vector<std::size_t> MeshState::around(const std::vector<std::size_t>& list, int from, int to) const {
  std::vector<std::size_t> out;
  for (const std::size_t n : list) {
    const Vec3i at = bricks.place(n);
    for (int a = from; a <= to; ++a)
      for (int b = from; b <= to; ++b)
        for (int c = from; c <= to; ++c)
          if (bricks.active(at.x + a, at.y + b, at.z + c)) out.push_back(bricks.index(at.x + a, at.y + b, at.z + c));
  }
  base::sort_unique(out);
  return out;
}

/// Returns a brick's vertices to their places before they chose and before they were pulled.
MeshState::BrickSnapshot MeshState::unsettle(std::size_t n) {
  BrickSnapshot out{n, {}, {}};
  const auto note = [&](const CellVertex& v) { out.places.emplace_back(v.vertex, surface.mesh.vertices[v.vertex]); };
  const std::vector<VertexChoice*> open = undecided(surface, {n});
  for (const MovedVertex& p : bricks.active(n)->pulled) note(p.at);
  for (const VertexChoice* s : open) note(s->at);
  out.pulled = undo_unfold(surface, n);
  for (const VertexChoice* s : open) surface.mesh.vertices[s->at.vertex] = s->safe;
  return out;
}

bool MeshState::moved(const BrickSnapshot& was) const {
  const auto elsewhere = [&](const auto& v) { return surface.mesh.vertices[v.first] != v.second; };
  if (std::any_of(was.places.begin(), was.places.end(), elsewhere)) return true;
  const auto noted = [&](const MovedVertex& p) {
    return std::any_of(was.places.begin(), was.places.end(), [&](const auto& v) { return v.first == p.at.vertex; });
  };
  const std::vector<MovedVertex>& pulled = bricks.active(was.brick)->pulled;
  return !std::all_of(pulled.begin(), pulled.end(), noted);
}

/// Chooses candidates in new bricks. The choices in the next bricks do not depend on the change, because it is too far
/// away (a choice reaches at most eight cells, one per group), but they are repeated in their turn.
void MeshState::choose_again(const std::vector<std::size_t>& fresh, const std::vector<Vec3i>& undone) {
  const std::vector<std::size_t> ring = without(around(fresh, -1, 1), fresh);
  const std::vector<VertexChoice*> known = undecided(surface, ring);
  std::vector<std::pair<std::int32_t, Vec3>> pulled;
  std::vector<Vec3i> cells;
  for (const std::size_t n : ring)
    for (const MovedVertex& p : bricks.active(n)->pulled) {
      pulled.emplace_back(p.at.vertex, surface.mesh.vertices[p.at.vertex]);
      cells.push_back(p.at.cell);
      surface.mesh.vertices[p.at.vertex] = p.before;
    }
  for (const VertexChoice* s : known) cells.push_back(s->at.cell);
  choose_candidates(surface, undecided(surface, fresh), known, {});
  for (const auto& [vertex, place] : pulled) surface.mesh.vertices[vertex] = place;
  // New quads treated their corners as undecided, and other quads lost what their diagonals were chosen for.
  cells.insert(cells.end(), undone.begin(), undone.end());
  for (const QuadRef& ref : quads_near(surface, cells, kAnyMark)) surface.split(ref, surface.hits);
}

/// The bricks that are not in the region and have a vertex that was pulled near one of these cells: a fold that moved
/// both started in one of the two, and may be gone.
std::vector<std::size_t> MeshState::entangled(const std::vector<Vec3i>& cells, const Region& region) const {
  constexpr int kReach = 2;  // cells between corners of two quads with a common side
  std::vector<std::size_t> out;
  for (const Vec3i& cell : cells)
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3i far = cell + kReach * Vec3i(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      if (far.x < 0 || far.y < 0 || far.z < 0) continue;
      const Vec3i at(far.x / kBrickSide, far.y / kBrickSide, far.z / kBrickSide);
      const ActiveBrick* const brick = bricks.active(at.x, at.y, at.z);
      if (!brick || region.has(bricks.index(at.x, at.y, at.z))) continue;
      const auto near = [&](const MovedVertex& p) {
        const Vec3i off = glm::abs(p.at.cell - cell);
        return std::max({off.x, off.y, off.z}) <= kReach;
      };
      if (std::any_of(brick->pulled.begin(), brick->pulled.end(), near)) out.push_back(bricks.index(at.x, at.y, at.z));
    }
  base::sort_unique(out);
  return out;
}

/// Unfolds new bricks, and those whose folds are entangled with theirs. Returns the latter. `undone`: the cells whose
/// vertices were pulled and are no longer.
std::vector<std::size_t> MeshState::unfold_again(const std::vector<std::size_t>& fresh,
                                                 const std::vector<Vec3i>& undone) {
  Region region;
  region.bricks.assign(bricks.size(), false);
  std::vector<std::size_t> bricks_in = fresh, next = fresh;
  std::vector<Vec3i> loose = undone;
  for (;;) {
    std::vector<Vec3i> cells;
    while (!next.empty()) {
      for (const std::size_t n : next) region.bricks[n] = true;
      for (const std::size_t n : bricks_in) {
        const std::vector<Vec3i> more = undo_unfold(surface, n);
        cells.insert(cells.end(), more.begin(), more.end());
        loose.insert(loose.end(), more.begin(), more.end());
      }
      next = entangled(loose, region);
      bricks_in.insert(bricks_in.end(), next.begin(), next.end());
      loose.clear();
    }
    base::sort_unique(bricks_in);
    for (const QuadRef& ref : quads_near(surface, cells, kAnyMark)) surface.split(ref, surface.hits);
    region.missing.clear();
    unfold(surface, quads_to_look_at(around(bricks_in, -1, 1)), region, {});
    if (region.missing.empty()) return without(bricks_in, fresh);
    next = region.missing;
    base::sort_unique(next);
    bricks_in.insert(bricks_in.end(), next.begin(), next.end());
    base::sort_unique(bricks_in);
  }
}

}  // namespace riffler::marching
