#include "mesh/decimate/flat_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "mesh/decimate/flat_brick.hpp"
#include "mesh/fold.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

/// Triangles of one brick: with their half-edges they fit a core's cache.
constexpr std::size_t kBrick = 1 << 14;
/// Bricks along a side of the box, at most.
constexpr int kMostAlong = 128;
/// Triangles that a thread sorts into bricks at a time.
constexpr std::size_t kSorted = 1 << 16;

/// The triangles by brick: cubes of a grid, or parts of one that holds too many.
class Bricks {
 public:
  /// `shift` moves the grid, in cubes.
  Bricks(const Mesh& mesh, double shift, const Progress& progress) : triangles_(mesh.triangles.size()) {
    set_grid(bounds(mesh), shift);
    std::vector<int> cube(triangles_.size());
    const std::size_t ranges = (triangles_.size() + kSorted - 1) / kSorted, cubes = cubes_;
    std::vector<int> at(ranges * cubes, 0);  // of each range and cube: first the number, then the place of the next one
    base::parallel_for(
        triangles_.size(), kSorted,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t t = begin; t < end; ++t) ++at[begin / kSorted * cubes + (cube[t] = cube_of(mesh, t))];
        },
        base::part(progress, 0, 0.5));
    begin_.push_back(0);
    int sum = 0;
    for (std::size_t c = 0; c < cubes; ++c) {
      const int first = sum;
      for (std::size_t r = 0; r < ranges; ++r) {
        const int here = at[r * cubes + c];
        at[r * cubes + c] = sum;
        sum += here;
      }
      const int parts = std::max<int>(1, (sum - first) / (2 * static_cast<int>(kBrick)));
      for (int k = 1; k <= parts && sum > first; ++k)
        begin_.push_back(first + static_cast<int>(static_cast<std::int64_t>(sum - first) * k / parts));
    }
    base::parallel_for(
        triangles_.size(), kSorted,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t t = begin; t < end; ++t)
            triangles_[at[begin / kSorted * cubes + cube[t]]++] = static_cast<int>(t);
        },
        base::part(progress, 0.5, 1));
  }

  std::size_t size() const { return begin_.size() - 1; }
  std::span<const int> operator[](std::size_t brick) const {
    return std::span(triangles_).subspan(begin_[brick], begin_[brick + 1] - begin_[brick]);
  }

 private:
  /// The box's surface, divided by the wanted number of bricks, gives the area of a cube's face.
  void set_grid(const Box3& box, double shift) {
    const Vec3 size = box.upper - box.lower;
    const double area = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
    const double wanted = std::max(1.0, static_cast<double>(triangles_.size()) / kBrick);
    const double longest = std::max({size.x, size.y, size.z});
    side_ = std::max(std::sqrt(area / wanted), longest / (kMostAlong - 2));
    origin_ = box.lower - shift * side_;
    cubes_ = 1;
    for (int k = 0; k < 3; ++k) {
      along_[k] = side_ > 0 ? static_cast<int>(size[k] / side_ + shift) + 1 : 1;
      cubes_ *= static_cast<std::size_t>(along_[k]);
    }
  }

  int cube_of(const Mesh& mesh, std::size_t t) const {
    const Vec3i& c = mesh.triangles[t];
    const Vec3 p = ((mesh.vertices[c.x] + mesh.vertices[c.y] + mesh.vertices[c.z]) / 3.0 - origin_) / side_;
    int cube = 0;
    for (int k = 2; k >= 0; --k)
      cube = cube * along_[k] + (p[k] > 0 ? std::min(static_cast<int>(p[k]), along_[k] - 1) : 0);
    return cube;
  }

  Vec3 origin_{0};
  double side_ = 0;
  int along_[3] = {1, 1, 1};
  std::size_t cubes_ = 1;
  std::vector<int> triangles_;
  std::vector<std::size_t> begin_;
};

/// The number of corners at each vertex, up to 255.
std::vector<std::uint8_t> corners_at(const Mesh& mesh) {
  std::vector<std::uint8_t> uses(mesh.vertices.size(), 0);
  for (const Vec3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) uses[t[k]] = static_cast<std::uint8_t>(std::min(255, uses[t[k]] + 1));
  return uses;
}

/// Drops the triangles that are gone, in order.
void drop_triangles(Triangles& triangles) {
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), [](const Vec3i& t) { return t.x < 0; }),
                  triangles.end());
}

/// Drops the vertices that no triangle uses. Returns where the others come from.
std::vector<int> drop_vertices(Mesh& mesh) {
  std::vector<int> number(mesh.vertices.size(), -1), source;
  for (const Vec3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) number[t[k]] = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(source.size());
    mesh.vertices[source.size()] = mesh.vertices[v];
    source.push_back(static_cast<int>(v));
  }
  mesh.vertices.resize(source.size());
  for (Vec3i& t : mesh.triangles) t = {number[t.x], number[t.y], number[t.z]};
  return source;
}

/// The bricks whose merges on curves would make a triangle fold onto one that another brick sees.
std::vector<char> folding(const std::vector<std::vector<FlatBrick::Side>>& sides) {
  struct Place {
    int lower, upper;
    std::size_t brick, side;
  };
  std::vector<Place> places;
  for (std::size_t brick = 0; brick < sides.size(); ++brick)
    for (std::size_t n = 0; n < sides[brick].size(); ++n) {
      const FlatBrick::Side& side = sides[brick][n];
      places.push_back({std::min(side.a, side.b), std::max(side.a, side.b), brick, n});
    }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::tie(a.lower, a.upper, a.brick, a.side) < std::tie(b.lower, b.upper, b.brick, b.side);
  });
  std::vector<char> out(sides.size(), 0);
  const auto side_at = [&](const Place& p) -> const FlatBrick::Side& { return sides[p.brick][p.side]; };
  const auto changed = [&](const Place& p) { return side_at(p).changed && !out[p.brick]; };
  const auto normal = [&](const Place& p) { return out[p.brick] ? side_at(p).before : side_at(p).after; };
  // A brick that keeps its triangles may fold with one that does not.
  for (bool again = true; again;) {
    again = false;
    for (std::size_t n = 0; n < places.size(); ++n)
      for (std::size_t m = n + 1; m < places.size() && places[m].lower == places[n].lower; ++m) {
        const Place &p = places[n], &q = places[m];
        if (q.upper != p.upper) break;
        if (side_at(p).a == side_at(q).a || !(changed(p) || changed(q)) || !opposed(normal(p), normal(q))) continue;
        for (const Place* one : {&p, &q})
          if (changed(*one)) out[one->brick] = 1, again = true;
      }
  }
  return out;
}

}  // namespace

FlatPass remove_inside_planes(Mesh& mesh, double slack, double curved, const Progress& progress) {
  FlatPass result;
  // Each turn has larger bricks at other places, so that what lay between two bricks lies inside of one.
  for (int turn = 0; turn < kFlatTurns && mesh.triangles.size() > 1; ++turn) {
    const Progress now = base::part(progress, turn == 0 ? 0 : 0.5 + 0.2 * (turn - 1), 0.5 + 0.2 * turn);
    const Bricks bricks(mesh, 0.5 * (turn % 2), base::part(now, 0, 0.2));
    const std::vector<std::uint8_t> uses = corners_at(mesh);
    std::vector<double> moved(bricks.size(), 0);
    std::vector<std::size_t> lost(bricks.size(), 0);
    const bool stars = turn == 0 && curved > 0;
    Triangles merged;  // with the merges on curves
    std::vector<std::vector<FlatBrick::Side>> sides(stars ? bricks.size() : 0);
    std::vector<double> errors(sides.size(), 0);
    if (stars) merged.resize(mesh.triangles.size());
    const auto run = [&](std::size_t i, std::size_t) {
      FlatBrick brick(mesh.vertices, mesh.triangles, bricks[i], uses);
      lost[i] = brick.run(slack);
      if (lost[i] > 0) {
        brick.store(mesh.triangles);
        moved[i] = brick.moved();
      }
      if (!stars) return;
      for (const int t : bricks[i]) merged[t] = mesh.triangles[t];
      errors[i] = brick.merge_stars(curved, sides[i]);
      brick.store(merged);
    };
    base::parallel_for(bricks.size(), 1, run, base::part(now, 0.2, 1));
    result.moved += *std::max_element(moved.begin(), moved.end());
    if (stars) {
      const std::vector<char> kept = folding(sides);
      double error = 0;
      for (std::size_t i = 0; i < bricks.size(); ++i) {
        if (kept[i]) continue;
        error = std::max(error, errors[i]);
        for (const int t : bricks[i]) mesh.triangles[t] = merged[t];
      }
      result.moved += error;
    }
    drop_triangles(mesh.triangles);
    if (std::accumulate(lost.begin(), lost.end(), std::size_t{0}) < mesh.triangles.size() / 16) break;
  }
  result.source = drop_vertices(mesh);
  base::report(progress, 1);
  return result;
}

}  // namespace riffler::mesh
