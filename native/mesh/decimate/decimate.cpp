#include "riffler/mesh/decimate/decimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/sort_unique.hpp"
#include "geom/float32.hpp"
#include "mesh/decimate/collapse.hpp"
#include "mesh/decimate/edge_costs.hpp"
#include "mesh/decimate/edge_queue.hpp"
#include "mesh/decimate/flat_pass.hpp"
#include "mesh/decimate/half_edge.hpp"
#include "mesh/decimate/map_check.hpp"
#include "mesh/decimate/patches.hpp"
#include "mesh/decimate/separate.hpp"
#include "mesh/decimate/tolerance_check.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

using OpenMesh::EdgeHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

// Fits the private cache of a core.
constexpr std::size_t kPatchVertices = 8192;

// Vertices or triangles that one thread prepares at a time.
constexpr std::size_t kPrepared = 1 << 16;

// Share of the tolerance by which vertices of a plane may miss it.
constexpr double kSlack = 1.0 / 512;

// Share of the tolerance for merges on curves before edges are queued. It doubles the speed on curves, and leaves a
// tenth more triangles.
constexpr double kCurved = 0.1;

void check_limits(const DecimateLimits& limits) {
  if (!limits.triangles && !limits.tolerance) throw std::invalid_argument("decimate needs triangles or tolerance");
  if (limits.tolerance && !(*limits.tolerance >= 0 && std::isfinite(*limits.tolerance)))
    throw std::invalid_argument("tolerance must be finite and not negative, not " + std::to_string(*limits.tolerance));
}

/// A mesh in float32's coordinates, relative to `centre`.
struct Rounded {
  Mesh mesh;
  double largest = 0;  // mm, the largest distance by which rounding moves a vertex
};

Rounded rounded(const Mesh& mesh, const Vec3& centre, const Progress& progress) {
  Rounded result;
  result.mesh.vertices.resize(mesh.vertices.size()), result.mesh.triangles.resize(mesh.triangles.size());
  std::vector<double> largest((mesh.vertices.size() + kPrepared - 1) / kPrepared, 0);
  base::parallel_for(
      mesh.vertices.size(), kPrepared,
      [&](std::size_t begin, std::size_t end) {
        double square = 0;
        for (std::size_t v = begin; v < end; ++v) {
          const Vec3 p = geom::to_float32(mesh.vertices[v]), off = p - mesh.vertices[v];
          square = std::max(square, glm::dot(off, off));
          result.mesh.vertices[v] = p - centre;
        }
        largest[begin / kPrepared] = std::sqrt(square);
      },
      base::part(progress, 0, 0.7));
  base::parallel_for(
      mesh.triangles.size(), kPrepared,
      [&](std::size_t begin, std::size_t end) {
        std::copy(&mesh.triangles[begin], mesh.triangles.data() + end, &result.mesh.triangles[begin]);
      },
      base::part(progress, 0.7, 1));
  result.largest = *std::max_element(largest.begin(), largest.end());
  return result;
}

/// Data shared by all patches.
struct Surface {
  HalfEdges& half_edges;
  EdgeCosts& costs;
  Traces* traces;  // null without a tolerance
  double tolerance;
};

/// Collapses the edges of one patch, cheapest first.
class Worker {
 public:
  explicit Worker(const Surface& surface) : mesh_(surface.half_edges.mesh), costs_(surface.costs), collapse_(mesh_) {
    if (surface.traces) check_.emplace(*surface.traces, surface.tolerance);
  }

  EdgeQueue& queue() { return queue_; }
  std::size_t lost() const { return lost_; }

  /// Queues all edges between inner vertices.
  void fill(const Patches& patches, std::size_t patch) {
    patches.for_each_vertex(patch, [&](VertexHandle v) {
      if (!patches.inner(v)) return;
      collapse_.for_each_spoke(v, [&](HalfedgeHandle spoke) {
        const VertexHandle other = mesh_.to_vertex_handle(spoke);
        if (v.idx() < other.idx() && patches.inner(other)) add(mesh_.edge_handle(spoke));
      });
    });
  }
  void fill() {
    for (int e = 0; e < static_cast<int>(mesh_.n_edges()); ++e)
      if (!mesh_.status(EdgeHandle(e)).deleted()) add(EdgeHandle(e));
  }

  /// Runs until the next edge's cost is beyond the bucket `last`, `quota` triangles are gone, or kTries edges were
  /// tried.
  void run(int last, std::size_t quota, const Patches* patches) {
    lost_ = 0;
    for (std::size_t tries = 0; lost_ < quota && tries < kTries && queue_.first() <= last; ++tries) {
      const EdgeQueue::Entry entry = queue_.pop();
      const EdgeHandle edge(entry.edge);
      if (costs_[edge] != entry.cost || mesh_.status(edge).deleted()) continue;
      const CollapseTarget place = costs_.place(edge);
      if ((!check_ || check_->find_anchor(place)) && collapse_.prepare(place) && (!check_ || check_->allow(collapse_)))
        commit(patches);
      else
        costs_.put_off(edge);
    }
  }

 private:
  static constexpr std::size_t kTries = 1 << 15;  // edges tried between two reports of progress

  void add(EdgeHandle edge) {
    if (!(costs_[edge] < std::numeric_limits<float>::infinity())) costs_.refresh(edge);
    queue_.push(edge.idx(), costs_[edge]);
  }

  void commit(const Patches* patches) {
    costs_.merge(collapse_.from(), collapse_.to());
    lost_ += static_cast<std::size_t>(collapse_.faces_lost());
    if (check_) check_->commit(collapse_);
    collapse_.commit();
    collapse_.for_each_spoke(collapse_.to(), [&](HalfedgeHandle spoke) {
      const EdgeHandle edge = mesh_.edge_handle(spoke);
      costs_.refresh(edge);
      if (!patches || patches->inner(mesh_.to_vertex_handle(spoke))) queue_.push(edge.idx(), costs_[edge]);
    });
  }

  HalfEdgeMesh& mesh_;
  EdgeCosts& costs_;
  Collapse collapse_;
  std::optional<ToleranceCheck> check_;
  EdgeQueue queue_;
  std::size_t lost_ = 0;
};

class Decimation {
 public:
  Decimation(const Surface& surface, std::size_t target, const Progress& progress)
      : surface_(surface),
        target_(target),
        start_(surface.half_edges.mesh.n_faces()),
        left_(start_),
        progress_(progress) {}

  void run() {
    for (int frame = 0; left_ > target_ + target_ / 32 && left_ > 2 * kPatchVertices; ++frame) {
      const std::size_t before = left_;
      run_patches(frame);
      if (left_ > before - before / 32) break;
    }
    for (std::size_t before = 2 * left_; left_ > target_ && left_ < before - before / 100;) {
      before = left_;
      run_whole();
    }
  }

 private:
  /// Works on one partition until about half of the triangles are gone or no edge is left.
  void run_patches(int frame) {
    const Patches patches(surface_.half_edges.mesh, frame, kPatchVertices, as_it_is());
    std::vector<std::unique_ptr<Worker>> workers(patches.size());
    for_each(patches.size(), [&](std::size_t i) {
      workers[i] = std::make_unique<Worker>(surface_);
      workers[i]->fill(patches, i);
    });
    const std::size_t enough = left_ / 2;
    int last = -1;
    while (left_ > target_ + target_ / 32 && left_ > enough) {
      int first = EdgeQueue::kLast + 1;
      for (const auto& worker : workers) first = std::min(first, worker->queue().first());
      if (first > EdgeQueue::kLast) return;
      if (first > last) last = first + kStep;
      const std::size_t quota = 2 * ((left_ - target_) / patches.size() / 4 + 1);
      for_each(patches.size(), [&](std::size_t i) { workers[i]->run(last, quota, &patches); });
      for (const auto& worker : workers) left_ -= worker->lost();
    }
  }

  void run_whole() {
    Worker worker(surface_);
    worker.fill();
    while (left_ > target_ && worker.queue().first() <= EdgeQueue::kLast) {
      base::report(progress_, share());
      worker.run(EdgeQueue::kLast, std::min<std::size_t>(512, left_ - target_), nullptr);
      left_ -= std::min(left_, worker.lost());
    }
  }

  double share() const {
    return 0.2 +
           0.8 * static_cast<double>(start_ - left_) / static_cast<double>(std::max<std::size_t>(1, start_ - target_));
  }
  template <class Body>
  void for_each(std::size_t n, const Body& body) {
    base::parallel_for(n, 1, [&](std::size_t i, std::size_t) { body(i); }, as_it_is());
  }
  /// Progress for steps that do not advance the share.
  Progress as_it_is() const {
    return [this, now = share()](double) { return !progress_ || progress_(now); };
  }

  static constexpr int kStep = 8;  // a factor of two in cost

  const Surface& surface_;
  std::size_t target_, start_, left_;
  const Progress& progress_;
};

/// Adds `far` to the vertices that stay. After two attempts without success, also adds a belt around all of them, twice
/// as wide each time: in the end every vertex stays.
void keep(const HalfEdges& half_edges, std::vector<int> far, int attempt, std::vector<int>& kept) {
  kept.insert(kept.end(), far.begin(), far.end());
  base::sort_unique(kept);
  std::vector<char> stays(half_edges.source.size(), 0);
  for (const int v : kept) stays[v] = 1;
  std::vector<int> belt;
  for (int ring = attempt < 2 ? 0 : 1 << std::min(attempt - 2, 24); ring > 0; --ring) {
    belt.clear();
    for (std::size_t half = 0; half < half_edges.corner.size(); half += 3) {
      const int* c = &half_edges.corner[half];
      if (c[0] < 0 || (!stays[c[0]] && !stays[c[1]] && !stays[c[2]])) continue;
      for (int k = 0; k < 3; ++k)
        if (!stays[c[k]]) belt.push_back(c[k]);
    }
    if (belt.empty()) break;
    for (const int v : belt) stays[v] = 1;
    kept.insert(kept.end(), belt.begin(), belt.end());
  }
  base::sort_unique(kept);
}

/// What is left to do once coordinates and limits are known.
struct Reduction {
  const Mesh& mesh;
  const Mesh& local;  // in float32's coordinates, relative to `centre`
  Vec3 centre;
  double grain, tolerance;
  std::size_t target;
  bool bounded;

  Mesh run(const Progress& progress) const {
    std::vector<int> kept;  // vertices that stay because the tolerance could not be proven otherwise
    double done = 0;
    for (int attempt = 0;; ++attempt) {
      // The first attempt is usually the last: reserve a tenth of the remaining progress for further ones.
      const double end = bounded ? done + 0.9 * (1 - done) : 1, proof = bounded ? 0.2 : 0;
      const Progress loop = base::part(progress, done, end - proof * (end - done));
      const Progress proving = base::part(progress, end - proof * (end - done), end);
      HalfEdges half_edges(local, base::part(loop, 0, 0.1));
      for (const int v : kept) half_edges.mesh.status(VertexHandle(v)).set_locked(true);
      EdgeCosts costs(half_edges, centre, grain, base::part(loop, 0.1, 0.18));
      std::optional<Traces> traces;
      if (bounded) traces.emplace(half_edges, base::part(loop, 0.18, 0.2));
      const Surface surface{half_edges, costs, traces ? &*traces : nullptr, tolerance};
      Decimation(surface, target, loop).run();
      std::vector<int> far;
      if (traces)
        far = MapCheck(*traces, tolerance, base::part(proving, 0, 0.3)).far_vertices(base::part(proving, 0.3, 1));
      if (far.empty()) return half_edges.to_mesh(mesh, local, centre);
      const std::size_t before = kept.size();
      keep(half_edges, std::move(far), attempt, kept);
      if (kept.size() == before) return mesh;
      done = end;
    }
  }
};

}  // namespace

Mesh decimate(const Mesh& mesh, const DecimateLimits& limits, const Progress& progress) {
  check_limits(limits);
  validate(mesh);
  const std::size_t target = limits.triangles.value_or(0);
  if (mesh.triangles.size() <= target || mesh.empty()) return mesh;

  // Work with the coordinates that a binary STL will hold, relative to the box's centre. Then area and folds are the
  // same as in the file, and quadrics keep their digits far from the origin.
  const Box3 box = bounds(mesh);
  const Vec3 centre = geom::to_float32(0.5 * box.lower + 0.5 * box.upper);
  auto [local, rounding] = rounded(mesh, centre, base::part(progress, 0, 0.04));
  const Vec3 corner = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  const double largest = std::max({corner.x, corner.y, corner.z}), reach = separation_reach(largest);
  // Both surfaces differ from their rounded ones.
  double tolerance = limits.tolerance ? std::max(0.0, *limits.tolerance - 2 * rounding) : 0;
  // If float32 is too coarse for the tolerance, vertices do not move.
  const bool may_move = !limits.tolerance || tolerance > 16 * reach;
  if (may_move) tolerance -= reach;
  const double grain = may_move ? std::ldexp(largest, -24) : std::numeric_limits<double>::infinity();
  const Progress rest = base::part(progress, 0.04, 1);
  if (!limits.tolerance || limits.triangles)
    return Reduction{mesh, local, centre, grain, tolerance, target, limits.tolerance.has_value()}.run(rest);

  FlatPass flats = remove_inside_planes(local, kSlack * tolerance, kCurved * tolerance, base::part(rest, 0, 0.2));
  Mesh left;
  for (const int v : flats.source) left.vertices.push_back(mesh.vertices[v]);
  left.triangles = local.triangles;
  const Progress reducing = base::part(rest, 0.2, 1);
  return Reduction{left, local, centre, grain, tolerance - flats.moved, target, true}.run(reducing);
}

}  // namespace riffler::mesh
