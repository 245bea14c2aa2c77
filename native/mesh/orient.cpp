#include "riffler/mesh/orient.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/adjacency.hpp"
#include "mesh/near_points.hpp"
#include "mesh/shells.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

/// Groups of triangles with the same vertices, in any order.
struct Groups {
  std::vector<int> of;     // each triangle's group; -1 if it names a vertex twice
  std::vector<int> first;  // the first triangle of each group
  std::vector<int> net;    // triangles oriented like the first one, minus those oriented against it
};

/// A triangle's vertices in ascending order, and whether that is an odd permutation.
std::pair<std::array<int, 3>, bool> sorted(const Vec3i& t) {
  std::array<int, 3> v{t.x, t.y, t.z};
  bool odd = false;
  const auto order = [&](int a, int b) {
    if (v[a] > v[b]) std::swap(v[a], v[b]), odd = !odd;
  };
  order(0, 1), order(1, 2), order(0, 1);
  return {v, odd};
}

bool has_crowds(const EdgeTable& edges) {
  std::atomic<bool> crowded{false};
  edges.for_each_edge([&](int, std::span<const EdgeTable::Use> uses) {
    if (uses.size() > 2) crowded.store(true, std::memory_order_relaxed);
  });
  return crowded;
}

/// Groups equal triangles. They share edges, which then have three or more triangles, unless a pair of them is a piece
/// of its own; such a pair stays two groups.
Groups group(const Mesh& mesh, bool crowded) {
  const int n = static_cast<int>(mesh.triangles.size());
  Groups out;
  out.of.assign(mesh.triangles.size(), -1);
  const auto add = [&](int t) {
    out.of[t] = static_cast<int>(out.first.size());
    out.first.push_back(t), out.net.push_back(1);
  };
  if (!crowded) {
    for (int t = 0; t < n; ++t)
      if (!repeats_a_vertex(mesh.triangles[t])) add(t);
    return out;
  }
  std::vector<std::pair<std::array<int, 3>, int>> order;
  for (int t = 0; t < n; ++t)
    if (!repeats_a_vertex(mesh.triangles[t])) order.emplace_back(sorted(mesh.triangles[t]).first, t);
  std::sort(order.begin(), order.end());
  std::vector<int> before(mesh.triangles.size(), -1);  // the previous equal triangle
  for (std::size_t k = 1; k < order.size(); ++k)
    if (order[k].first == order[k - 1].first) {
      const int last = order[k - 1].second;
      before[order[k].second] = before[last] < 0 ? last : before[last];
    }
  for (int t = 0; t < n; ++t) {
    if (repeats_a_vertex(mesh.triangles[t])) continue;
    if (before[t] < 0) {
      add(t);
      continue;
    }
    out.of[t] = out.of[before[t]];
    out.net[out.of[t]] += sorted(mesh.triangles[t]).second == sorted(mesh.triangles[before[t]]).second ? 1 : -1;
  }
  return out;
}

/// A piece of the surface, connected across edges that exactly two triangles share.
struct Piece {
  int net = 0;                   // of all its triangles, if `agrees`
  bool agrees = true;            // all its triangles occur equally often with equal orientation
  bool one_sided = false;        // its triangles cannot be oriented consistently
  double with = 0, against = 0;  // twice the areas of the triangles oriented like the first one, and against it
};

/// The pieces, with one triangle per group.
class Pieces {
 public:
  Pieces(const Mesh& mesh, const Groups& groups) : groups_(groups), turned_(groups.first.size(), 0) {
    mesh_.vertices = mesh.vertices;
    mesh_.triangles.reserve(groups.first.size());
    for (const int t : groups.first) mesh_.triangles.push_back(mesh.triangles[t]);
    const EdgeTable edges(mesh_);
    find(Adjacency(mesh_, edges));
    open_.assign(pieces_.size(), 0);
    edges.for_each_edge([&](int, std::span<const EdgeTable::Use> uses) { look(uses); });
  }

  const Mesh& mesh() const { return mesh_; }
  const std::vector<Piece>& pieces() const { return pieces_; }
  int piece_of(std::size_t group) const { return of_[group]; }
  /// Whether the group's first triangle is oriented against the piece's first.
  bool turned(std::size_t group) const { return turned_[group]; }
  int net(std::size_t group) const { return turned_[group] ? -groups_.net[group] : groups_.net[group]; }
  bool closed(std::size_t piece) const { return !open_[piece] && !pieces_[piece].one_sided; }

 private:
  void find(const Adjacency& adjacency) {
    of_.assign(turned_.size(), -1);
    std::vector<int> pending;
    for (std::size_t seed = 0; seed < of_.size(); ++seed) {
      if (of_[seed] >= 0) continue;
      const int piece = static_cast<int>(pieces_.size());
      pieces_.emplace_back().net = groups_.net[seed];
      of_[seed] = piece;
      pending.push_back(static_cast<int>(seed));
      while (!pending.empty()) {
        const int at = pending.back();
        pending.pop_back();
        visit(at, adjacency, pending);
      }
    }
  }

  void visit(int at, const Adjacency& adjacency, std::vector<int>& pending) {
    Piece& piece = pieces_[of_[at]];
    const Vec3i& t = mesh_.triangles[at];
    const Vec3& a = mesh_.vertices[t.x];
    const double area = glm::length(glm::cross(mesh_.vertices[t.y] - a, mesh_.vertices[t.z] - a));
    const int n = net(static_cast<std::size_t>(at));
    piece.agrees &= n == piece.net;
    if (n != 0) (n > 0 ? piece.with : piece.against) += area;
    for (int half = 3 * at; half < 3 * at + 3; ++half) {
      const int across = adjacency.neighbour(half);
      if (across < 0) continue;
      const int other = triangle_of(across);
      const bool turned = turned_[at] != adjacency.is_same_way(half);
      if (of_[other] < 0) {
        of_[other] = of_[at], turned_[other] = turned;
        pending.push_back(other);
      } else if (turned_[other] != turned) {
        piece.one_sided = true;
      }
    }
  }

  /// Marks pieces that end at this edge.
  void look(std::span<const EdgeTable::Use> uses) {
    if (uses.size() == 2 && of_[triangle_of(uses[0].half())] == of_[triangle_of(uses[1].half())]) return;
    for (const EdgeTable::Use& use : uses) {
      const int piece = of_[triangle_of(use.half())];
      int sum = 0;
      for (const EdgeTable::Use& other : uses)
        if (of_[triangle_of(other.half())] == piece)
          sum += other.reversed() != turned_[triangle_of(other.half())] ? -1 : 1;
      if (sum != 0) std::atomic_ref(open_[piece]).store(1, std::memory_order_relaxed);
    }
  }

  const Groups& groups_;
  Mesh mesh_;
  std::vector<int> of_;
  std::vector<char> turned_;
  std::vector<Piece> pieces_;
  std::vector<std::uint8_t> open_;
};

/// Decides for each piece: 0 keeps it, otherwise each group becomes one triangle, +1 oriented like its first one, −1
/// against it. A piece without contradictions keeps its number of copies.
class Decision {
 public:
  Decision(const Pieces& pieces, Hollow hollow, Orientation& found)
      : pieces_(pieces), sign_(pieces.pieces().size(), 0) {
    const std::vector<Piece>& all = pieces.pieces();
    std::vector<int> shell(all.size(), -1);
    for (std::size_t p = 0; p < all.size(); ++p) {
      found.one_sided += all[p].one_sided;
      if (!pieces.closed(p) || (all[p].agrees && all[p].net == 0)) continue;
      const int given = all[p].agrees ? (all[p].net > 0 ? 1 : -1) : (all[p].with >= all[p].against ? 1 : -1);
      if (!all[p].agrees) sign_[p] = given;
      shell[p] = static_cast<int>(shells_.size());
      const bool tie = std::abs(all[p].with - all[p].against) <= 1e-9 * (all[p].with + all[p].against);
      shells_.push_back({p, given, !all[p].agrees && tie});
    }
    if (!shells_.empty()) turn_shells(shell, hollow, found);
  }

  int sign(std::size_t piece) const { return sign_[piece]; }

 private:
  struct Shell {
    std::size_t piece;
    int given;  // orientation of most of its triangles
    bool tie;   // half of them have each orientation
  };

  void turn_shells(const std::vector<int>& shell, Hollow hollow, Orientation& found) {
    std::vector<int> of(pieces_.mesh().triangles.size());
    std::vector<int> runs(of.size());
    for (std::size_t g = 0; g < of.size(); ++g) {
      of[g] = shell[static_cast<std::size_t>(pieces_.piece_of(g))];
      if (of[g] >= 0) runs[g] = pieces_.turned(g) ? -shells_[of[g]].given : shells_[of[g]].given;
    }
    std::vector<std::uint8_t> ties;
    for (const Shell& s : shells_) ties.push_back(s.tie);
    const std::vector<ShellSide> sides = shell_sides(pieces_.mesh(), of, runs, ties);
    bool all = hollow == Hollow::Kept;
    for (std::size_t k = 0; k < shells_.size(); ++k)
      all = all && (sides[k].volume == 0 || (sides[k].turn && pieces_.pieces()[shells_[k].piece].agrees));
    if (all) return;
    for (std::size_t k = 0; k < shells_.size(); ++k) {
      if (!sides[k].turn) continue;
      const Piece& piece = pieces_.pieces()[shells_[k].piece];
      sign_[shells_[k].piece] = -shells_[k].given;
      if (!piece.agrees) continue;
      ++found.turned_shells, found.turned_volume += sides[k].volume;
    }
  }

  const Pieces& pieces_;
  std::vector<int> sign_;
  std::vector<Shell> shells_;
};

Vec3i turned(const Vec3i& t) {
  return {t.x, t.z, t.y};
}

/// The triangles of `mesh` after the decision.
Mesh rebuilt(const Mesh& mesh, const Groups& groups, const Pieces& pieces, const Decision& decision, const Mesh& joined,
             Orientation& found) {
  Mesh out;
  out.vertices = mesh.vertices;
  std::vector<bool> done(groups.first.size(), false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int group = groups.of[t];
    const Vec3i& triangle = mesh.triangles[t];
    if (group < 0) {
      out.triangles.push_back(triangle);
      continue;
    }
    const auto g = static_cast<std::size_t>(group), p = static_cast<std::size_t>(pieces.piece_of(g));
    const int sign = decision.sign(p), net = pieces.net(g);
    if (sign == 0 || sign == net) {
      out.triangles.push_back(triangle);
    } else if (pieces.pieces()[p].agrees) {
      out.triangles.push_back(sign * net > 0 ? triangle : turned(triangle));
    } else if (done[g]) {
      ++found.left_out;
      out.triangles.emplace_back(triangle.x);
    } else {
      done[g] = true;
      const bool like_first = sorted(joined.triangles[t]).second == sorted(joined.triangles[groups.first[g]]).second;
      const bool turns = (sign > 0) == (pieces.turned(g) == like_first);
      found.turned += turns;
      out.triangles.push_back(turns ? turned(triangle) : triangle);
    }
  }
  return out;
}

bool is_manifold(const EdgeTable& edges) {
  std::atomic<bool> good{true};
  edges.for_each_edge([&](int, std::span<const EdgeTable::Use> uses) {
    if (uses.size() != 2 || uses[0].reversed() == uses[1].reversed()) good.store(false, std::memory_order_relaxed);
  });
  return good;
}

}  // namespace

std::optional<Mesh> oriented(const Mesh& mesh, Orientation& found, Hollow hollow) {
  found = {};
  std::optional<Mesh> storage;
  const Mesh* joined = &mesh;
  bool crowded = false;
  if (const EdgeTable edges(mesh); !is_manifold(edges)) {
    joined = &storage.emplace(welded(mesh));
    crowded = has_crowds(EdgeTable(*joined));
  }
  const Groups groups = group(*joined, crowded);
  const Pieces pieces(*joined, groups);
  const Decision decision(pieces, hollow, found);
  bool any = false;
  for (std::size_t p = 0; p < pieces.pieces().size(); ++p) any |= decision.sign(p) != 0;
  if (!any) return {};
  Mesh out = rebuilt(mesh, groups, pieces, decision, *joined, found);
  if (!found.changed()) return {};
  return out;
}

const Mesh& as_solid(const Mesh& mesh, std::optional<Mesh>& storage, Hollow hollow) {
  Orientation found;
  storage = oriented(mesh, found, hollow);
  return storage ? *storage : mesh;
}

}  // namespace riffler::mesh
