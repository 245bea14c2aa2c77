#include "dexel/openings.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

#include "dexel/boundary_tree.hpp"
#include "geom/parallel.hpp"

namespace riffler {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kLeaf = 8;                             // columns and cells of a leaf's sides
constexpr int kTask = 32;                            // of a task's
constexpr double kShortest = 1.0 / (1 << 20);        // cells: a piece of a column at an edge is not halved further
constexpr double kRoot = 1e-9;                       // cells: where the search along a column ends
constexpr double kLevel = 1e-6, kLevelBound = 2e-3;  // of K: measured and proven deviation from ½ that counts as none

/// Columns [i0, i1) × [j0, j1) from z0 to z1, in cells.
struct Block {
  int i0, i1, j0, j1;
  double z0, z1;

  Vec3 centre() const { return {0.5 * (i0 + i1 - 1), 0.5 * (j0 + j1 - 1), 0.5 * (z0 + z1)}; }
  Vec3 half() const { return {0.5 * (i1 - 1 - i0), 0.5 * (j1 - 1 - j0), 0.5 * (z1 - z0)}; }
  bool within(int side) const { return i1 - i0 <= side && j1 - j0 <= side && z1 - z0 <= side; }
};

/// Calls body for the parts of a block, halved along every side longer than half the longest (and than `side`).
template <class Body>
void halves(const Block& b, int side, const Body& body) {
  const double longest = std::max({static_cast<double>(b.i1 - b.i0), static_cast<double>(b.j1 - b.j0), b.z1 - b.z0});
  const auto split = [&](double length) { return length > side && 2 * length > longest; };
  const int i = split(b.i1 - b.i0) ? (b.i0 + b.i1) / 2 : b.i1, j = split(b.j1 - b.j0) ? (b.j0 + b.j1) / 2 : b.j1;
  const double z = split(b.z1 - b.z0) ? 0.5 * (b.z0 + b.z1) : b.z1;
  const auto part = [&](int i0, int i1, int j0, int j1, double z0, double z1) {
    if (i0 < i1 && j0 < j1 && z0 < z1) body(Block{i0, i1, j0, j1, z0, z1});
  };
  part(b.i0, i, b.j0, j, b.z0, z), part(i, b.i1, b.j0, j, b.z0, z);
  part(b.i0, i, j, b.j1, b.z0, z), part(i, b.i1, j, b.j1, b.z0, z);
  part(b.i0, i, b.j0, j, z, b.z1), part(i, b.i1, b.j0, j, z, b.z1);
  part(b.i0, i, j, b.j1, z, b.z1), part(i, b.i1, j, b.j1, z, b.z1);
}

/// Searches blocks for passages.
class Search {
 public:
  using Rounded = std::function<int(int row, int column, double z)>;

  Search(const BoundaryTree& tree, const Rounded& rounded, bool with_gradients, std::vector<Passage>& out)
      : tree_(tree), rounded_(rounded), with_gradients_(with_gradients), out_(out) {}

  /// Whether K may pass ½ in the block: second-order bound about its centre.
  bool may_pass(const Block& block) {
    const Vec3 half = block.half();
    const double curvature = tree_.gather(block.centre(), half, field_, true);
    if (curvature == std::numeric_limits<double>::infinity()) return true;
    phase_ = field_.at(block.centre(), gradient_);
    remainder_ = 0.5 * curvature * glm::dot(half, half);
    return std::abs(phase_) <= glm::dot(glm::abs(gradient_), half) + remainder_ + kSlack;
  }

  void block(const Block& block) {
    if (block.within(kLeaf)) return leaf(block);
    if (!may_pass(block)) return;
    halves(block, kLeaf, [&](const Block& part) { this->block(part); });
  }

 private:
  /// Phases are that much in error (multipoles), with room to spare.
  static constexpr double kSlack = 1e-4;

  void leaf(const Block& block) {
    const Vec3 centre = block.centre(), half = block.half();
    const double curvature = tree_.gather(centre, half, field_);
    if (curvature < std::numeric_limits<double>::infinity()) {
      phase_ = field_.at(centre, gradient_);
      remainder_ = 0.5 * curvature * glm::dot(half, half);
    } else {
      phase_ = 0, gradient_ = Vec3(0), remainder_ = 1;
    }
    const double along = std::abs(gradient_.z) * half.z + remainder_ + kSlack;
    for (int i = block.i0; i < block.i1; ++i)
      for (int j = block.j0; j < block.j1; ++j) {
        if (std::abs(phase_ + gradient_.x * (i - centre.x) + gradient_.y * (j - centre.y)) > along) continue;
        row_ = i, column_ = j;
        field_.set_column(i, j);
        segment(block.z0, block.z1);
      }
  }

  /// Passages with z0 ≤ z ≤ z1 on the column set. One at an end may be found from both sides.
  void segment(double z0, double z1) {
    const double z = 0.5 * (z0 + z1), half = 0.5 * (z1 - z0);
    const Field::Value value = field_.at(z);
    const double curvature = field_.curvature(z, half);
    if (std::abs(value.phase) > std::abs(value.slope) * half + 0.5 * curvature * half * half + kSlack * half) return;
    if (std::abs(value.slope) > 2 * curvature * half) return newton(z0, z1, value);
    const double variation = field_.variation(z, half, value.slope);
    if (std::abs(value.phase) > variation + kSlack * half) return;
    // A column in the plane of a flat opening, where K is ½ throughout: either side will do.
    const bool level = std::abs(value.phase) + std::abs(value.slope) * half < kLevel && variation < kLevelBound;
    if (half > kShortest && !level) {
      segment(z0, z), segment(z, z1);
      return;
    }
    // At an edge the same decisions as for crossings tell on which side of it the column passes.
    const int change = rounded_(row_, column_, z1) - rounded_(row_, column_, z0);
    for (int k = 0; k < std::abs(change); ++k) add(z, change > 0);
  }

  /// The one root of a phase whose slope varies by less than half of itself.
  void newton(double z0, double z1, Field::Value value) {
    double z = 0.5 * (z0 + z1);
    const bool rising = value.slope > 0;
    const double room = 1e-3 * (z1 - z0);
    for (int step = 0; step < 30; ++step) {
      const double move = -value.phase / value.slope;
      z += move;
      if (z < z0 - 0.5 * (z1 - z0) || z > z1 + 0.5 * (z1 - z0)) return;
      if (std::abs(move) < kRoot * (1 + std::abs(z)) || (step > 0 && move * move < kRoot * (z1 - z0))) break;
      value = field_.at(z);
    }
    if (z >= z0 - room && z <= z1 + room) add(z, rising);
  }

  void add(double z, bool rising) {
    Passage passage{row_, column_, rising ? 1 : -1, z, Vec3(0)};
    if (with_gradients_) field_.at(Vec3(row_, column_, z), passage.gradient);
    out_.push_back(passage);
  }

  const BoundaryTree& tree_;
  const Rounded& rounded_;  // K rounded to an integer, by boundary_winding
  bool with_gradients_;
  std::vector<Passage>& out_;
  Field field_;
  double phase_ = 0, remainder_ = 0;
  Vec3 gradient_{0};
  int row_ = 0, column_ = 0;
};

/// How far above and below the part |w| may still reach ½, cells: |w| is at most area / (4 π d²), and at most
/// boundary / (4 π d).
double margin(const Mesh& mesh, double pitch, double boundary) {
  const double area_cells = area(mesh) / (pitch * pitch);
  return 1.01 * std::min(std::sqrt(area_cells / (2 * kPi)), boundary / (2 * kPi)) + 1;
}

/// Sorted; a passage that two blocks found at their common face stands once.
void tidy(std::vector<Passage>& passages) {
  std::sort(passages.begin(), passages.end(), [](const Passage& a, const Passage& b) {
    return std::tie(a.row, a.column, a.z) < std::tie(b.row, b.column, b.z);
  });
  const auto end = std::unique(passages.begin(), passages.end(), [](const Passage& a, const Passage& b) {
    return a.row == b.row && a.column == b.column && a.sign == b.sign && b.z - a.z < 1e-2;
  });
  passages.erase(end, passages.end());
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
  const BoundaryTree tree(points);
  const Box3 box = to_local(grid.axis(), bounds(mesh));
  const double more = margin(mesh, pitch, tree.length());
  const double bottom = std::floor((box.lower.z - base) / pitch - more), top = (box.upper.z - base) / pitch + more;

  // Down to tasks on one thread, then task by task on all.
  std::vector<Block> tasks, pending{{0, grid.nu(), 0, grid.nv(), bottom, top}};
  std::vector<Passage> passages;
  const Search::Rounded rounded = [&](int row, int column, double z) {
    return static_cast<int>(std::lround(boundary_winding(loops, projection, pitch, row, column, base + z * pitch)));
  };
  Search top_level(tree, rounded, grid.has_normals(), passages);
  while (!pending.empty()) {
    const Block block = pending.back();
    pending.pop_back();
    if (!top_level.may_pass(block)) continue;
    if (block.within(kTask))
      tasks.push_back(block);
    else
      halves(block, kTask, [&](const Block& part) { pending.push_back(part); });
  }
  std::vector<std::vector<Passage>> found(tasks.size());
  parallel_for(
      tasks.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) Search(tree, rounded, grid.has_normals(), found[k]).block(tasks[k]);
      },
      progress);
  for (const std::vector<Passage>& part : found) passages.insert(passages.end(), part.begin(), part.end());
  tidy(passages);
  for (Passage& p : passages) p.z = base + p.z * pitch;
  return passages;
}

double boundary_winding(const std::vector<std::vector<int>>& loops, const Projection& projection, double pitch, int row,
                        int column, double z) {
  double sum = 0;
  for (const std::vector<int>& loop : loops)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Projection::Vertex &from = projection.vertex(loop[k]), &to = projection.vertex(loop[(k + 1) % loop.size()]);
      // The ray stands off the lattice as in Projection, by (ε², ε): so little that no vertex is between.
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
        // Which side of the edge the ray is on decides the branch, as it decides what crosses the column.
        const double v = low.v + (row - low.u) / (high.u - low.u) * (high.v - low.v);
        const bool left = column >= projection.column(low, high, row, v);
        im = left == up ? std::abs(im) : -std::abs(im);
      }
      sum += std::atan2(im, re);
    }
  return sum / (2 * kPi);
}

}  // namespace riffler
