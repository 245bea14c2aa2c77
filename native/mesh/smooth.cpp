#include "riffler/mesh/smooth.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/functions.hpp"
#include "geom/float32.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/fold.hpp"
#include "mesh/weld.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

constexpr std::size_t kVertexGrain = 1 << 13;
constexpr double kShrink = 0.5, kInflate = -0.51;

// Two feature edges that meet at a sharper angle form a corner; cosine of that angle.
constexpr double kCorner = -0.5;

/// The vertices that pull each vertex: all its neighbours; on a feature line the two along it; none if it must stay.
class Neighbours {
 public:
  Neighbours(const Mesh& mesh, const Adjacency& adjacency, double feature_angle, const Progress& progress)
      : begin_(mesh.vertices.size() + 1, 0) {
    std::vector<char> fixed(mesh.vertices.size(), 0);
    const int halves = static_cast<int>(3 * mesh.triangles.size());
    for (int half = 0; half < halves; ++half)
      if (adjacency.twin(half) < 0) fixed[start_of(mesh, half)] = fixed[end_of(mesh, half)] = 1;
    const std::vector<char> sharp = sharp_edges(mesh, adjacency, feature_angle);
    base::report(progress, 0.4);
    std::vector<Line> lines(mesh.vertices.size());
    for (int half = 0; half < halves; ++half)
      if (sharp[half]) lines[start_of(mesh, half)].add(end_of(mesh, half));
    // Around a vertex without a border, every neighbour is the end of exactly one half-edge. A single feature edge is
    // the end of a line that fades away.
    const auto draws = [&](int half) {
      const int v = start_of(mesh, half);
      return !fixed[v] && (lines[v].count < 2 || (lines[v].goes_on(mesh, v) && sharp[half]));
    };
    for (int half = 0; half < halves; ++half)
      if (draws(half)) ++begin_[start_of(mesh, half) + 1];
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    base::report(progress, 0.8);
    other_.resize(begin_.back());
    std::vector<std::size_t> at(begin_.begin(), begin_.end() - 1);
    for (int half = 0; half < halves; ++half)
      if (draws(half)) other_[at[start_of(mesh, half)]++] = end_of(mesh, half);
  }

  std::span<const int> of(std::size_t v) const {
    return std::span(other_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
  }

 private:
  /// The feature edges at a vertex.
  struct Line {
    int count = 0;
    int ends[2] = {-1, -1};
    void add(int end) {
      if (count < 2) ends[count] = end;
      ++count;
    }
    bool goes_on(const Mesh& mesh, int v) const {
      if (count != 2) return false;
      const Vec3 a = mesh.vertices[ends[0]] - mesh.vertices[v], b = mesh.vertices[ends[1]] - mesh.vertices[v];
      return glm::dot(a, b) < kCorner * glm::length(a) * glm::length(b);
    }
  };

  /// For every half-edge, whether the normals on its sides differ by more than `angle`.
  static std::vector<char> sharp_edges(const Mesh& mesh, const Adjacency& adjacency, double angle) {
    const auto cross = [&](int t) {
      const Vec3i& v = mesh.triangles[t];
      const Vec3& a = mesh.vertices[v.x];
      return glm::cross(mesh.vertices[v.y] - a, mesh.vertices[v.z] - a);
    };
    const double least = base::cos(angle);
    std::vector<char> sharp(3 * mesh.triangles.size(), 0);
    base::parallel_for(sharp.size(), kVertexGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t half = begin; half < end; ++half) {
        const int twin = adjacency.twin(static_cast<int>(half));
        if (twin < 0) continue;
        const Vec3 a = cross(static_cast<int>(half / 3)), b = cross(twin / 3);
        const double lengths = glm::length(a) * glm::length(b);
        sharp[half] = lengths > 0 && glm::dot(a, b) < least * lengths;
      }
    });
    return sharp;
  }

  std::vector<std::size_t> begin_;
  std::vector<int> other_;
};

/// p, or if it is farther than `limit` from `home`, the point at that distance in its direction.
Vec3 limited(const Vec3& p, const Vec3& home, double limit) {
  const Vec3 moved = p - home;
  const double length = glm::length(moved);
  return length > limit ? home + (limit / length) * moved : p;
}

/// Moves every vertex towards (factor > 0) or away from the mean of its neighbours.
void step(const Vertices& from, Vertices& to, const Mesh& mesh, const Neighbours& neighbours, double factor,
          double limit) {
  base::parallel_for(from.size(), kVertexGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const std::span<const int> others = neighbours.of(v);
      to[v] = from[v];
      if (others.empty()) continue;
      Vec3 sum(0);
      for (const int other : others) sum += from[other] - from[v];
      to[v] = limited(from[v] + (factor / static_cast<double>(others.size())) * sum, mesh.vertices[v], limit);
    }
  });
}

/// Moves every vertex along its normal, in proportion to how far it has moved already, so that the mesh regains its
/// volume. Vertices that have not moved stay.
void restore_volume(const Mesh& mesh, Vertices& vertices, double limit, const Progress& progress) {
  constexpr int kRounds = 3;  // the first round is exact up to the square of the shift and up to what `limit` prevents
  const double wanted = volume(mesh);
  Mesh now{vertices, mesh.triangles};
  for (int round = 0; round < kRounds; ++round) {
    base::report(progress, static_cast<double>(round) / kRounds);
    std::vector<Vec3> slope(vertices.size(), Vec3(0));  // gradient of the volume, times 6
    for (const Vec3i& t : mesh.triangles) {
      const Vec3 &a = now.vertices[t.x], &b = now.vertices[t.y], &c = now.vertices[t.z];
      const Vec3 cross = glm::cross(b - a, c - a);
      slope[t.x] += cross, slope[t.y] += cross, slope[t.z] += cross;
    }
    double sum = 0;
    for (std::size_t v = 0; v < slope.size(); ++v)
      sum += glm::length(slope[v]) / 6 * glm::length(now.vertices[v] - mesh.vertices[v]);
    base::report(progress, (round + 0.5) / kRounds);
    const double missing = wanted - volume(now), share = missing / sum;
    // A correction as large as the smoothing itself would make no sense.
    if (missing == 0 || !(std::abs(share) < 0.5)) break;
    for (std::size_t v = 0; v < slope.size(); ++v) {
      const double length = glm::length(slope[v]), far = glm::length(now.vertices[v] - mesh.vertices[v]);
      if (length > 0 && far > 0)
        now.vertices[v] = limited(now.vertices[v] + (share * far / length) * slope[v], mesh.vertices[v], limit);
    }
  }
  vertices = std::move(now.vertices);
}

Vec3 cross_in_float(const Vertices& vertices, const Vec3i& t) {
  const Vec3 a = geom::to_float32(vertices[t.x]), b = geom::to_float32(vertices[t.y]),
             c = geom::to_float32(vertices[t.z]);
  return glm::cross(b - a, c - a);
}

/// Moves vertices back until the mesh has no defect, in the last resort all of them.
class Repair {
 public:
  Repair(const Mesh& mesh, const Adjacency& adjacency, Vertices& vertices)
      : mesh_(mesh), vertices_(vertices), adjacency_(adjacency) {
    for (const Vec3i& t : mesh.triangles) old_.push_back(cross_in_float(mesh.vertices, t));
  }

  void run(const Progress& progress) {
    for (int round = 0;; ++round) {
      const auto hear = [&](double middle) { base::report(progress, (round + middle) / (round + 2.0)); };
      hear(0);
      back_.assign(vertices_.size(), 0);
      mark_triangles();
      hear(0.5);
      mark_meeting();
      bool any = false;
      for (std::size_t v = 0; v < back_.size(); ++v)
        if (back_[v] && vertices_[v] != mesh_.vertices[v]) vertices_[v] = mesh_.vertices[v], any = true;
      if (!any) return;
    }
  }

 private:
  void mark(int t) {
    for (int k = 0; k < 3; ++k) back_[mesh_.triangles[t][k]] = 1;
  }

  void mark_triangles() {
    std::vector<Vec3> now(mesh_.triangles.size());
    base::parallel_for(now.size(), kVertexGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) now[t] = cross_in_float(vertices_, mesh_.triangles[t]);
    });
    for (int t = 0; t < static_cast<int>(now.size()); ++t) {
      if (old_[t] != Vec3(0) && !(glm::dot(now[t], old_[t]) > 0)) mark(t);
      for (int half = 3 * t; half < 3 * t + 3; ++half)
        if (const int twin = adjacency_.twin(half); twin > half && opposed(now[t], now[twin / 3]))
          if (!opposed(old_[t], old_[twin / 3])) mark(t), mark(twin / 3);
    }
  }

  /// Marks vertices that coincide with another one.
  void mark_meeting() {
    Welder<Vec3> welder(vertices_.size());
    std::vector<int> first;
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      const int place = welder.add(geom::to_float32(vertices_[v]));
      if (place == static_cast<int>(first.size()))
        first.push_back(static_cast<int>(v));
      else
        back_[v] = back_[first[place]] = 1;
    }
  }

  const Mesh& mesh_;
  Vertices& vertices_;
  const Adjacency& adjacency_;
  std::vector<Vec3> old_;
  std::vector<char> back_;
};

}  // namespace

Mesh smooth(const Mesh& mesh, int iterations, std::optional<double> tolerance, const Progress& progress) {
  return smooth(mesh, iterations, tolerance, kFeatureAngle, progress);
}

Mesh smooth(const Mesh& mesh, int iterations, std::optional<double> tolerance, double feature_angle,
            const Progress& progress) {
  if (iterations < 0) throw std::invalid_argument("iterations must not be negative, not " + std::to_string(iterations));
  if (tolerance && !(*tolerance >= 0 && std::isfinite(*tolerance)))
    throw std::invalid_argument("tolerance must be finite and not negative, not " + std::to_string(*tolerance));
  if (!(feature_angle > 0 && feature_angle <= base::acos(-1.0)))
    throw std::invalid_argument("feature_angle must be above 0 and at most pi, not " + std::to_string(feature_angle));
  validate(mesh);
  const EdgeTable edges(mesh);
  base::report(progress, 0.03);
  const Adjacency adjacency(mesh, edges);
  const Neighbours neighbours(mesh, adjacency, feature_angle, base::part(progress, 0.06, 0.1));
  // Slightly less than requested, so that rounding does not exceed it.
  const double limit = tolerance ? *tolerance * (1 - 1e-12) : std::numeric_limits<double>::infinity();
  Vertices vertices = mesh.vertices, scratch(vertices.size());
  for (int i = 0; i < iterations; ++i) {
    base::report(progress, 0.1 + 0.7 * i / iterations);
    step(vertices, scratch, mesh, neighbours, kShrink, limit);
    step(scratch, vertices, mesh, neighbours, kInflate, limit);
  }
  base::report(progress, 0.8);
  if (iterations > 0) {
    restore_volume(mesh, vertices, limit, base::part(progress, 0.8, 0.9));
    Repair(mesh, adjacency, vertices).run(base::part(progress, 0.9, 1));
  }
  return {std::move(vertices), mesh.triangles};
}

}  // namespace riffler::mesh
