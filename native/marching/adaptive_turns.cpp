#include "marching/adaptive_turns.hpp"

#include <algorithm>

#include "base/sort_unique.hpp"
#include "marching/plain_brick.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::marching {

void AdaptiveState::follow(std::size_t layer, const std::vector<std::size_t>& changed,
                           const std::vector<std::size_t>& owners, const Progress& progress) {
  find_folds(layers_[layer], Turns(*this, layer, changed, owners).run(layers_[layer], progress));
}

AdaptiveState::Turns::Turns(const AdaptiveState& state, std::size_t layer, const std::vector<std::size_t>& changed,
                            const std::vector<std::size_t>& owners)
    : state_(state),
      bricks_(state.surface_.bricks),
      before_(layer > 0 ? &state.layers_[layer - 1] : nullptr),
      marks_(bricks_.size()),
      borders_(bricks_.size()) {
  for (const std::size_t n : changed) touch(n, kChanged | kTouched);
  for (const std::size_t n : owners) touch(n, kOwner);
}

/// Marks a brick. Makes candidates of the bricks whose groups may have a vertex or a triangle in it.
void AdaptiveState::Turns::touch(std::size_t brick, std::uint8_t mark) {
  if ((marks_[brick] & mark) == mark) return;
  marks_[brick] |= mark;
  const Vec3i at = bricks_.place(brick);
  for (int i = at.x - 1; i <= at.x + 1; ++i)
    for (int j = at.y - 1; j <= at.y + 1; ++j)
      for (int k = at.z - 1; k <= at.z + 1; ++k) {
        if (!bricks_.has(i, j, k)) continue;
        const std::size_t n = bricks_.index(i, j, k);
        if (!(marks_[n] & kCandidate)) candidates_.push_back(n);
        marks_[n] |= kCandidate;
      }
}

std::vector<std::size_t> AdaptiveState::Turns::run(Layer& layer, const Progress& progress) {
  for (std::size_t turn = 0; turn < kTurns.size(); ++turn) {
    const int group = kTurns[turn];
    const std::vector<std::size_t> tasks = due(layer, group);
    prepare(layer, tasks, turn);
    std::vector<Result> now(tasks.size());
    const double from = 0.05 * static_cast<double>(turn);
    base::parallel_for(
        tasks.size(),
        tasks.size() > 1024 ? 32
        : tasks.size() > 64 ? 8
                            : 1,
        [&](std::size_t begin, std::size_t end) {
          GroupInput input;
          mesh::StarCollapser collapser({input.vertices, input.triangles, input.errors}, state_.tolerance_);
          for (std::size_t n = begin; n < end; ++n) now[n] = result(layer, tasks[n], group, input, collapser);
        },
        base::part(progress, from, group == 0 ? 1 : from + 0.05));
    for (std::size_t n = 0; n < tasks.size(); ++n) {
      Result& kept = layer.results[tasks[n]][group];
      keep(tasks[n], group, kept, now[n]);
      kept = std::move(now[n]);
    }
  }
  base::sort_unique(renewed_);
  return std::move(renewed_);
}

/// Whether a group's input may have changed.
bool AdaptiveState::Turns::is_due(const Vec3i& at, int group, const GroupResult* old) const {
  if (marks_[bricks_.index(at.x, at.y, at.z)] & kOwner) return true;
  bool out = false;
  at_sides(at, group, [&](int, std::size_t n) { out |= (marks_[n] & kTouched) != 0; });
  if (out || !old) return out;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k) {
        if (!(old->bricks >> VertexName::place_of({i, j, k}) & 1)) continue;
        if (marks_[bricks_.index(at.x + i, at.y + j, at.z + k)] & kChanged) return true;
      }
  return false;
}

/// The active bricks whose group must be simplified again. Drops the results of bricks that are no longer active.
std::vector<std::size_t> AdaptiveState::Turns::due(Layer& layer, int group) {
  std::vector<std::size_t> out;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {  // `keep` may add some
    const std::size_t n = candidates_[c];
    Result& old = layer.results[n][group];
    if (!bricks_.active(n)) {
      keep(n, group, old, nullptr);
      old.reset();
    } else if (is_due(bricks_.place(n), group, old.get())) {
      out.push_back(n);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Marks the bricks that a changed result touches.
void AdaptiveState::Turns::keep(std::size_t brick, int group, const Result& old, const Result& now) {
  if (old == now) return;
  if (group == 0) {
    renewed_.push_back(brick);
    return;
  }
  at_sides(bricks_.place(brick), group, [&](int side, std::size_t n) {
    if (!old || !now || !now->same_at(side, *old)) touch(n, kTouched);
  });
}

/// Brings the border triangles that these groups need to their state before a turn.
void AdaptiveState::Turns::prepare(const Layer& layer, const std::vector<std::size_t>& tasks, std::size_t turn) {
  std::vector<std::size_t> needed;
  for (const std::size_t task : tasks)
    at_sides(bricks_.place(task), kTurns[turn], [&](int, std::size_t n) {
      if (bricks_.active(n)) needed.push_back(n);
    });
  base::sort_unique(needed);
  base::parallel_for(needed.size(), needed.size() > 64 ? 8 : 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) advance(layer, needed[n], turn);
  });
}

void AdaptiveState::Turns::advance(const Layer& layer, std::size_t brick, std::size_t turn) {
  const BorderTriangles& border = state_.groups_.border(brick);
  const Vec3i at = bricks_.place(brick);
  std::unique_ptr<BorderState>& state = borders_[brick];
  if (!state) {
    state = std::make_unique<BorderState>();
    state->faces.reserve(border.triangles.size());
    const VertexOwners owners(bricks_, at);
    const Vec3i* const triangles = state_.surface_.mesh.triangles.data() + 2 * bricks_.active(brick)->first_edge;
    const auto name = [&](std::int32_t v) {
      const VertexOwners::Owner owner = owners.of(v);
      return VertexName(-offset_of(owner.side), owner.local);
    };
    for (const std::uint32_t t : border.triangles) {
      const Vec3i& v = triangles[t];
      state->faces.push_back({{name(v.x), name(v.y), name(v.z)}, 0, false});
    }
  }
  for (; state->turn < turn; ++state->turn) {
    const int group = kTurns[state->turn];
    for (int side = 0; side < 8; ++side) {
      const Vec3i below = at - offset_of(side);
      if (!reaches(group, side) || !bricks_.has(below.x, below.y, below.z)) continue;
      const GroupResult* const from = layer.results[bricks_.index(below.x, below.y, below.z)][group].get();
      if (!from) continue;
      std::uint32_t t = from->begin[side];
      for (const std::uint32_t place : border.around(side, group)) {
        BorderFace& face = state->faces[place];
        face.error = from->errors[t];
        face.removed = from->triangles[t].x < 0;
        if (!face.removed) {
          face.v = from->corners(t);
          for (VertexName& v : face.v) v = v.seen_from(offset_of(side));
        }
        ++t;
      }
    }
  }
}

/// The result of a group: the earlier one if its input has not changed, null if it has no triangles.
AdaptiveState::Result AdaptiveState::Turns::result(const Layer& layer, std::size_t brick, int group, GroupInput& input,
                                                   mesh::StarCollapser& collapser) const {
  const Vec3i at = bricks_.place(brick);
  input.clear();
  if (!(group == 0 ? gather_inside(brick, input) : gather_border(at, group, input))) return nullptr;
  mark_movable(layer, brick, group, input);
  if (!state_.follows_) {
    input.simplify(collapser, group);
    return std::make_shared<const GroupResult>(GroupResult::of(input, group == 0));
  }
  input.hash();
  if (before_)
    if (const Result& same = before_->results[brick][group]; same && same->made_from == input.digest) return same;
  if (const Result& old = layer.results[brick][group]; old && old->made_from == input.digest) {
    GroupResult renamed = old->renamed(input);
    if (renamed.names == old->names && renamed.bricks == old->bricks) return old;
    return std::make_shared<const GroupResult>(std::move(renamed));
  }
  input.simplify(collapser, group);
  return std::make_shared<const GroupResult>(GroupResult::of(input, group == 0));
}

bool AdaptiveState::Turns::gather_border(const Vec3i& at, int group, GroupInput& input) const {
  std::vector<BorderFace>& faces = input.faces;
  VertexNumbers numbers(input.names);
  for (int side = 0; side < 8; ++side) {
    input.begin[side] = static_cast<std::uint32_t>(faces.size());
    const Vec3i other = at + offset_of(side);
    if (!reaches(group, side) || !bricks_.active(other.x, other.y, other.z)) continue;
    const std::size_t n = bricks_.index(other.x, other.y, other.z);
    for (const std::uint32_t place : state_.groups_.border(n).around(side, group)) {
      BorderFace& face = faces.emplace_back(borders_[n]->faces[place]);
      if (face.removed) continue;
      for (VertexName& v : face.v) numbers.add(v = v.seen_from(-offset_of(side)));
    }
  }
  input.begin[8] = static_cast<std::uint32_t>(faces.size());
  if (input.names.empty()) return false;
  numbers.finish();
  for (const BorderFace& face : faces) {
    Vec3i& t = input.triangles.emplace_back(-1);
    for (int c = 0; c < 3 && !face.removed; ++c) t[c] = numbers.of(face.v[static_cast<std::size_t>(c)]);
    input.errors.push_back(face.error);
  }
  for (const VertexName& v : input.names)
    input.vertices.push_back(state_.surface_.mesh.vertices[static_cast<std::size_t>(state_.number(at, v))]);
  return true;
}

bool AdaptiveState::Turns::gather_inside(std::size_t brick, GroupInput& input) const {
  const ActiveBrick& active = *bricks_.active(brick);
  if (active.edges() == 0) return false;
  if (active.plain && active.pulled.empty()) {
    gather_plain(brick, input);
    return true;
  }
  const std::vector<BorderFace>& faces = borders_[brick]->faces;
  const std::vector<std::uint32_t>& border = state_.groups_.border(brick).triangles;
  const Mesh& mesh = state_.surface_.mesh;
  const auto own = [](const VertexName& v) { return v.offset() == Vec3i(0); };
  for (const BorderFace& face : faces) {
    if (face.removed) continue;
    for (const VertexName& v : face.v)
      if (!own(v)) input.names.push_back(v);
  }
  base::sort_unique(input.names);  // all before the brick's own
  const auto foreign = static_cast<std::int32_t>(input.names.size());
  for (const VertexName& v : input.names)
    input.vertices.push_back(mesh.vertices[static_cast<std::size_t>(state_.number(active.at, v))]);
  input.names.resize(foreign + active.vertices());
  for (std::size_t v = 0; v < active.vertices(); ++v) input.names[foreign + v] = {Vec3i(0), v};
  const auto own_vertices = mesh.vertices.begin() + static_cast<std::ptrdiff_t>(active.first_vertex);
  input.vertices.insert(input.vertices.end(), own_vertices,
                        own_vertices + static_cast<std::ptrdiff_t>(active.vertices()));
  const auto number = [&](const VertexName& v) {
    if (own(v)) return foreign + static_cast<std::int32_t>(v.local());
    const auto end = input.names.begin() + foreign;
    return static_cast<std::int32_t>(std::lower_bound(input.names.begin(), end, v) - input.names.begin());
  };
  const Vec3i shift(foreign - static_cast<std::int32_t>(active.first_vertex));
  const std::size_t all = 2 * active.edges();
  input.triangles.resize(all), input.errors.resize(all);
  for (std::size_t t = 0; t < all; ++t)
    input.triangles[t] = mesh.triangles[2 * active.first_edge + t] + shift, input.errors[t] = 0;
  for (std::size_t n = 0; n < border.size(); ++n) {
    const BorderFace& face = faces[n];
    input.errors[border[n]] = face.error;
    input.triangles[border[n]] =
        face.removed ? Vec3i(-1) : Vec3i(number(face.v[0]), number(face.v[1]), number(face.v[2]));
  }
  std::fill(input.begin.begin() + 1, input.begin.end(), static_cast<std::uint32_t>(input.triangles.size()));
  return true;
}

/// The inside of a plain brick, with the few triangles of `flat_square` instead of its own.
void AdaptiveState::Turns::gather_plain(std::size_t brick, GroupInput& input) const {
  const ActiveBrick& active = *bricks_.active(brick);
  const std::vector<BorderFace>& faces = borders_[brick]->faces;
  const FlatSquare& square = flat_square();
  VertexNumbers numbers(input.names);
  for (const BorderFace& face : faces)
    for (std::size_t c = 0; c < 3 && !face.removed; ++c) numbers.add(face.v[c]);
  for (const std::uint32_t v : square.vertices) input.names.push_back({Vec3i(0), v});
  numbers.finish();
  for (const VertexName& v : input.names)
    input.vertices.push_back(state_.surface_.mesh.vertices[static_cast<std::size_t>(state_.number(active.at, v))]);
  for (const BorderFace& face : faces) {
    if (face.removed) continue;
    Vec3i& t = input.triangles.emplace_back();
    for (int c = 0; c < 3; ++c) t[c] = numbers.of(face.v[static_cast<std::size_t>(c)]);
    input.errors.push_back(face.error);
  }
  // From u to v is clockwise seen from the end of the second axis, because the first and the third are then u and v.
  const bool swapped = (active.plain->axis == 1) != active.plain->rising;
  for (const auto& t : square.triangles) {
    const std::int32_t a = numbers.of({Vec3i(0), t[0]}), b = numbers.of({Vec3i(0), t[1]}),
                       c = numbers.of({Vec3i(0), t[2]});
    input.triangles.push_back(swapped ? Vec3i(a, c, b) : Vec3i(a, b, c));
    input.errors.push_back(0);
  }
  std::fill(input.begin.begin() + 1, input.begin.end(), static_cast<std::uint32_t>(input.triangles.size()));
}

void AdaptiveState::Turns::mark_movable(const Layer& layer, std::size_t brick, int group, GroupInput& input) const {
  const std::size_t first = bricks_.active(brick)->first_vertex;
  const auto fixed = layer.fixed.find(brick);
  input.movable.resize(input.names.size());
  for (std::size_t n = 0; n < input.names.size(); ++n) {
    const VertexName& v = input.names[n];
    const bool own = v.offset() == Vec3i(0) && state_.groups_.of(first + v.local()) == group;
    const bool stays =
        own && fixed != layer.fixed.end() && std::binary_search(fixed->second.begin(), fixed->second.end(), v.local());
    input.movable[n] = own && !stays;
  }
}

}  // namespace riffler::marching
