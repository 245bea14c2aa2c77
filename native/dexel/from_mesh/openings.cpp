#include "dexel/from_mesh/openings.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/functions.hpp"
#include "dexel/from_mesh/boundary_field.hpp"
#include "dexel/from_mesh/opening_search.hpp"
#include "geom/math.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::dexel {

namespace {

constexpr std::size_t kTasks = 512;  // number of blocks the grid is divided into before each is searched alone

/// Distance above and below the part within which |w| may still reach ½, cells: |w| is at most area / (4 π d²), and at
/// most boundary / (4 π d).
double margin(const Mesh& mesh, double pitch, double boundary) {
  const double area_cells = area(mesh) / (pitch * pitch);
  return 1.01 * std::min(std::sqrt(area_cells / (2 * kPi)), boundary / (2 * kPi)) + 1;
}

/// All passages, sorted; a passage that two blocks found at their common face appears once.
std::vector<Passage> sorted(std::vector<std::vector<Passage>> found, int rows) {
  std::vector<std::size_t> begin(static_cast<std::size_t>(rows) + 1, 0);
  for (const std::vector<Passage>& part : found)
    for (const Passage& p : part) ++begin[p.row + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Passage> all(begin.back());
  std::vector<std::size_t> end = begin;
  for (std::vector<Passage>& part : found) {
    for (const Passage& p : part) all[end[p.row]++] = p;
    part = {};
  }
  base::parallel_for(static_cast<std::size_t>(rows), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row)
      std::sort(all.begin() + begin[row], all.begin() + end[row], [](const Passage& a, const Passage& b) {
        return std::tie(a.column, a.z, a.sign) < std::tie(b.column, b.z, b.sign);
      });
  });
  all.erase(std::unique(all.begin(), all.end(),
                        [](const Passage& a, const Passage& b) {
                          return a.row == b.row && a.column == b.column && a.sign == b.sign && b.z - a.z < 1e-2;
                        }),
            all.end());
  return all;
}

}  // namespace

std::vector<Passage> find_passages(const Mesh& mesh, const std::vector<std::vector<int>>& loops,
                                   const Projection& projection, const Grid& grid, const Progress& progress) {
  const double pitch = grid.pitch(), base = grid.box().lower.z;
  std::vector<std::vector<Vec3>> points;
  for (const std::vector<int>& loop : loops) {
    points.emplace_back();
    for (const int k : loop) {
      const Projection::Vertex& p = projection.vertex(k);
      points.back().emplace_back(p.u, p.v, (p.z - base) / pitch);
    }
  }
  const BoundaryPieces pieces(points);
  const Box3 box = to_local(grid.axis(), bounds(mesh));
  const double more = margin(mesh, pitch, pieces.length());
  const double bottom = std::floor((box.lower.z - base) / pitch - more), top = (box.upper.z - base) / pitch + more;

  const OpeningSearch::Rounded rounded = [&](int row, int column, double z) {
    return static_cast<int>(std::lround(boundary_winding(loops, projection, pitch, row, column, base + z * pitch)));
  };
  // Divide level by level until there are enough blocks for all threads, then search each block alone.
  struct Task {
    OpeningSearch::Block block;
    OpeningSearch::Tangent tangent;
    std::shared_ptr<const Surroundings> within;
    std::vector<Passage> found;
    std::vector<Task> parts;
  };
  const OpeningSearch::Block whole{0, grid.nu(), 0, grid.nv(), bottom, top};
  const double radius = glm::length(whole.half());
  std::vector<Task> tasks(1);
  tasks[0] = {whole, {}, std::make_shared<Surroundings>(Descent(pieces).root(whole.centre(), radius)), {}, {}};
  bool divisible = true;
  for (double begin = 0; divisible && tasks.size() < kTasks && !tasks.empty(); begin += 0.02) {
    divisible = false;
    base::parallel_for(
        tasks.size(), 1,
        [&](std::size_t k, std::size_t) {
          Task& task = tasks[k];
          OpeningSearch search(pieces, rounded, grid, task.found);
          auto around = std::make_shared<Surroundings>();
          search.enter(task.block, *task.within, *around);
          search.parts(task.block, *around, [&](const OpeningSearch::Block& b, const OpeningSearch::Tangent& t) {
            task.parts.push_back({b, t, around, {}, {}});
          });
        },
        base::part(progress, begin, begin + 0.02));
    std::vector<Task> next;
    for (Task& task : tasks)
      for (Task& inner : task.parts) {
        divisible |= !inner.block.within(OpeningSearch::kLeaf);
        next.push_back(std::move(inner));
      }
    tasks = std::move(next);
  }
  base::parallel_for(
      tasks.size(), 1,
      [&](std::size_t k, std::size_t) {
        OpeningSearch(pieces, rounded, grid, tasks[k].found).block(tasks[k].block, tasks[k].tangent, *tasks[k].within);
      },
      base::part(progress, 0.3, 1));
  std::vector<std::vector<Passage>> found;
  for (Task& task : tasks) found.push_back(std::move(task.found));
  std::vector<Passage> passages = sorted(std::move(found), grid.nu());
  for (Passage& p : passages) p.z = base + p.z * pitch;
  return passages;
}

double boundary_winding(const std::vector<std::vector<int>>& loops, const Projection& projection, double pitch, int row,
                        int column, double z) {
  double sum = 0;
  for (const std::vector<int>& loop : loops)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Projection::Vertex &from = projection.vertex(loop[k]), &to = projection.vertex(loop[(k + 1) % loop.size()]);
      // The ray is shifted off the lattice by (ε², ε), as in Projection: so little that no vertex lies between.
      constexpr double kAside = 1.0 / (1LL << 34), kLess = 1.0 / (1LL << 40);
      const Vec3 a(from.u - row - kLess, from.v - column - kAside, (from.z - z) / pitch);
      const Vec3 b(to.u - row - kLess, to.v - column - kAside, (to.z - z) / pitch);
      const double aa = a.x * a.x + a.y * a.y, bb = b.x * b.x + b.y * b.y;
      const double length_a = std::sqrt(aa + a.z * a.z), length_b = std::sqrt(bb + b.z * b.z);
      const double t_a = a.z < 0 ? aa / (length_a - a.z) : length_a + a.z;
      const double t_b = b.z < 0 ? bb / (length_b - b.z) : length_b + b.z;
      const double re = t_a * t_b + a.x * b.x + a.y * b.y;
      double im = a.x * b.y - a.y * b.x;
      const bool up = from.u <= to.u;
      const Projection::Vertex &low = up ? from : to, &high = up ? to : from;
      if (re < 0 && low.row <= row && row < high.row) {
        // The side of the edge on which the ray passes decides the branch, exactly as it decides what crosses the
        // column.
        const double v = low.v + (row - low.u) / (high.u - low.u) * (high.v - low.v);
        const bool left = column >= projection.column(low, high, row, v);
        im = left == up ? std::abs(im) : -std::abs(im);
      }
      sum += base::atan2(im, re);
    }
  return sum / (2 * kPi);
}

}  // namespace riffler::dexel
