#include "dexel/openings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "dexel/boundary_field.hpp"
#include "dexel/field.hpp"
#include "geom/parallel.hpp"

namespace riffler {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kLeaf = 4;                             // columns and cells of a leaf's sides at least
constexpr std::size_t kTasks = 512;                  // blocks into which the grid is cut before each is searched alone
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

/// K at a block's centre as a phase, with its gradient there, and a bound of how far K in the block may be from that
/// tangent plane: infinity where an edge may pass through.
struct Tangent {
  double phase, remainder;
  Vec3 gradient;
};
constexpr Tangent kNoTangent{0, std::numeric_limits<double>::infinity(), Vec3(0)};

/// Columns and cells of the sides of blocks that are searched column by column: the less of the boundary is near, the
/// less a column costs beside what it costs to divide a block.
int leaf_side(const Surroundings& around) {
  const std::size_t near = around.near.size();
  return near <= 32 ? 4 * kLeaf : near <= 128 ? 2 * kLeaf : kLeaf;
}

/// Searches blocks for passages.
class Search {
 public:
  using Rounded = std::function<int(int row, int column, double z)>;

  Search(const BoundaryPieces& pieces, const Rounded& rounded, const Grid& grid, std::vector<Passage>& out)
      : pieces_(pieces), descent_(pieces), rounded_(rounded), grid_(grid), out_(out) {}

  /// Calls body for the parts of a block, whose surroundings are `around`, in which K may pass ½.
  template <class Body>
  void parts(const Block& block, const Surroundings& around, const Body& body) {
    field_.fill(pieces_, around);
    parts(block, around.far.curved(block.half()), body);
  }

  void enter(const Block& block, const Surroundings& within, Surroundings& around) {
    descent_.enter(within, block.centre(), glm::length(block.half()), around);
  }

  void block(const Block& block, const Tangent& tangent, const Surroundings& within, std::size_t depth = 0) {
    if (depth == levels_.size()) levels_.emplace_back();
    Surroundings& around = levels_[depth];
    enter(block, within, around);
    if (block.within(leaf_side(around))) return leaf(block, tangent, around);
    parts(block, around, [&](const Block& part, const Tangent& t) { this->block(part, t, around, depth + 1); });
  }

 private:
  /// Phases are that much in error (polynomials), with room to spare.
  static constexpr double kSlack = 1e-4;

  /// The same with the present field, `curved` the polynomial's bound for halves of the block.
  template <class Body>
  void parts(const Block& block, double curved, const Body& body) {
    std::array<Block, kPoints> parts;
    std::size_t count = 0;
    halves(block, kLeaf, [&](const Block& part) { parts[count++] = part; });
    FieldPoints points;
    for (std::size_t k = 0; k < kPoints; ++k) set(points, k, parts[std::min(k, count - 1)]);
    FieldValues values;
    field_.at(points, true, values);
    std::array<Tangent, kPoints> tangents;
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3 half = parts[k].half();
      // The polynomial's bound is for parts of half the size along every axis.
      const bool halved = glm::all(glm::lessThanEqual(half, 0.5 * block.half()));
      const double bend = 0.5 * (field_.rays() + values.curvature[k]) * glm::dot(half, half);
      tangents[k] = {
          values.phase[k], bend + (halved ? curved : 4 * curved), {values.gx[k], values.gy[k], values.gz[k]}};
      if (tangents[k].remainder > 1) tangents[k] = kNoTangent;
    }
    for (std::size_t k = 0; k < count; ++k) {
      const Tangent& t = tangents[k];
      const double most = glm::dot(glm::abs(t.gradient), parts[k].half()) + t.remainder + kSlack;
      if (std::abs(t.phase) <= most) body(parts[k], t);
    }
  }

  /// A piece of a column, z0 ≤ z ≤ z1.
  struct Piece {
    int row, column;
    double z0, z1;

    double middle() const { return 0.5 * (z0 + z1); }
    double half() const { return 0.5 * (z1 - z0); }
  };
  /// One with what is known of K at its middle.
  struct Doubt {
    Piece piece;
    double phase, slope;
  };
  /// One in which K passes ½ once, where a search for that place has got to.
  struct Root {
    Piece piece;
    double z;
    bool rising;
    int steps;
  };

  static void set(FieldPoints& points, std::size_t k, const Block& block) {
    const Vec3 centre = block.centre();
    points.x[k] = centre.x, points.y[k] = centre.y, points.z[k] = centre.z;
    const Vec3 half = block.half();
    points.half_x[k] = half.x, points.half_y[k] = half.y, points.half_z[k] = half.z;
  }
  static void set(FieldPoints& points, std::size_t k, const Piece& piece, double z) {
    points.x[k] = piece.row, points.y[k] = piece.column, points.z[k] = z;
    points.half_x[k] = points.half_y[k] = 0, points.half_z[k] = piece.half();
  }

  /// Takes up to kPoints items from the end of `items`; the points are those of the first where there are less.
  template <class Item, class At>
  static std::size_t take(std::vector<Item>& items, std::array<Item, kPoints>& taken, FieldPoints& points,
                          const At& at) {
    const std::size_t count = std::min<std::size_t>(items.size(), kPoints);
    std::copy(items.end() - static_cast<std::ptrdiff_t>(count), items.end(), taken.begin());
    items.resize(items.size() - count);
    for (std::size_t k = 0; k < kPoints; ++k) {
      const Item& item = taken[k < count ? k : 0];
      at(item, points, k);
    }
    return count;
  }

  /// A block that is searched in its own surroundings to the end.
  void leaf(const Block& block, const Tangent& tangent, const Surroundings& around) {
    field_.fill(pieces_, around);
    curved_ = around.far.curvature_along(block.half());
    columns(block, tangent, around.far.curved(block.half()));
    while (!segments_.empty() || !doubts_.empty()) {
      // Lanes should be full.
      if (segments_.empty() || doubts_.size() >= kPoints)
        doubts();
      else
        segments();
    }
    while (!roots_.empty()) roots();
    normals();
  }

  /// Columns of the leaf's blocks in which K may pass ½, `curved` the polynomial's bound for halves of the block.
  void columns(const Block& block, const Tangent& t, double curved) {
    if (!field_.smooth() && !block.within(kLeaf)) {
      const Vec3 half = block.half();
      parts(block, curved, [&](const Block& part, const Tangent& inner) {
        const bool halved = glm::all(glm::lessThanEqual(part.half(), 0.5 * half));
        columns(part, inner, halved ? 0.25 * curved : curved);
      });
      return;
    }
    const Vec3 centre = block.centre();
    const double along = std::abs(t.gradient.z) * block.half().z + t.remainder + kSlack;
    for (int i = block.i0; i < block.i1; ++i)
      for (int j = block.j0; j < block.j1; ++j)
        if (std::abs(t.phase + t.gradient.x * (i - centre.x) + t.gradient.y * (j - centre.y)) <= along)
          segments_.push_back({i, j, block.z0, block.z1});
  }

  /// Passages on some pieces. One at an end may be found from both sides.
  void segments() {
    std::array<Piece, kPoints> pieces;
    FieldPoints points;
    FieldValues values;
    const std::size_t count = take(segments_, pieces, points,
                                   [](const Piece& p, FieldPoints& to, std::size_t k) { set(to, k, p, p.middle()); });
    field_.at(points, false, values);
    for (std::size_t k = 0; k < count; ++k) {
      const double half = points.half_z[k], phase = values.phase[k], slope = values.gz[k];
      const double curvature = field_.rays() + curved_ + values.curvature[k];
      if (std::abs(phase) > std::abs(slope) * half + 0.5 * curvature * half * half + kSlack * half) continue;
      if (std::abs(slope) > 2 * curvature * half)
        newton({pieces[k], points.z[k], slope > 0, 0}, phase, slope);
      else
        doubts_.push_back({pieces[k], phase, slope});
    }
  }

  /// Pieces that second derivatives do not settle.
  void doubts() {
    std::array<Doubt, kPoints> taken;
    FieldPoints points;
    const std::size_t count = take(doubts_, taken, points, [](const Doubt& d, FieldPoints& to, std::size_t k) {
      set(to, k, d.piece, d.piece.middle());
    });
    double slopes[kPoints], variation[kPoints];
    for (std::size_t k = 0; k < kPoints; ++k) slopes[k] = taken[k < count ? k : 0].slope;
    field_.variation(points, slopes, curved_, variation);
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [piece, phase, slope] = taken[k];
      const double half = points.half_z[k], z = points.z[k];
      if (std::abs(phase) > variation[k] + kSlack * half) continue;
      // A column in the plane of a flat opening, where K is ½ throughout: either side will do.
      const bool level = std::abs(phase) + std::abs(slope) * half < kLevel && variation[k] < kLevelBound;
      if (half > kShortest && !level) {
        segments_.push_back({piece.row, piece.column, piece.z0, z});
        segments_.push_back({piece.row, piece.column, z, piece.z1});
        continue;
      }
      // At an edge the same decisions as for crossings tell on which side of it the column passes.
      const int change = rounded_(piece.row, piece.column, piece.z1) - rounded_(piece.row, piece.column, piece.z0);
      for (int n = 0; n < std::abs(change); ++n) add(piece, z, change > 0);
    }
  }

  /// One evaluation for the roots of phases whose slopes vary by less than half of themselves.
  void roots() {
    std::array<Root, kPoints> taken;
    FieldPoints points;
    FieldValues values;
    const std::size_t count =
        take(roots_, taken, points, [](const Root& r, FieldPoints& to, std::size_t k) { set(to, k, r.piece, r.z); });
    field_.at(points, false, values);
    for (std::size_t k = 0; k < count; ++k) newton(taken[k], values.phase[k], values.gz[k]);
  }

  /// A step of Newton's method.
  void newton(Root root, double phase, double slope) {
    const double z0 = root.piece.z0, z1 = root.piece.z1, length = z1 - z0, room = 1e-3 * length;
    const double move = -phase / slope;
    root.z += move;
    if (root.z < z0 - 0.5 * length || root.z > z1 + 0.5 * length) return;
    const bool done = std::abs(move) < kRoot * (1 + std::abs(root.z)) ||
                      (root.steps > 0 && move * move < kRoot * length) || root.steps == 29;
    ++root.steps;
    if (!done)
      roots_.push_back(root);
    else if (root.z >= z0 - room && root.z <= z1 + room)
      add(root.piece, root.z, root.rising);
  }

  void add(const Piece& piece, double z, bool rising) {
    out_.push_back({piece.row, piece.column, z, rising ? 1 : -1, {}});
  }

  /// Of the passages that have none yet.
  void normals() {
    if (!grid_.has_normals()) return;
    for (; complete_ < out_.size(); complete_ += kPoints) {
      FieldPoints points;
      FieldValues values;
      const auto passages = std::span(out_).subspan(complete_);
      for (std::size_t k = 0; k < kPoints; ++k) {
        const Passage& p = passages[k < passages.size() ? k : 0];
        set(points, k, {p.row, p.column, p.z, p.z}, p.z);
      }
      field_.at(points, true, values);
      for (std::size_t k = 0; k < std::min<std::size_t>(kPoints, passages.size()); ++k) {
        const Vec3 gradient(values.gx[k], values.gy[k], values.gz[k]);
        const double length = glm::length(gradient);
        const Vec3 normal = length > 0 ? gradient / -length : Vec3(0, 0, -passages[k].sign);
        passages[k].normal = PackedNormal::pack(to_world(grid_.axis(), normal));
      }
    }
    complete_ = out_.size();
  }

  const BoundaryPieces& pieces_;
  Descent descent_;
  const Rounded& rounded_;  // K rounded to an integer, by boundary_winding
  const Grid& grid_;
  std::vector<Passage>& out_;
  std::deque<Surroundings> levels_;  // of the blocks that enclose the present one
  Field field_;
  double curved_ = 0;  // of the polynomial along the leaf's columns
  std::vector<Piece> segments_;
  std::vector<Doubt> doubts_;
  std::vector<Root> roots_;
  std::size_t complete_ = 0;  // passages that have their normals
};

/// How far above and below the part |w| may still reach ½, cells: |w| is at most area / (4 π d²), and at most
/// boundary / (4 π d).
double margin(const Mesh& mesh, double pitch, double boundary) {
  const double area_cells = area(mesh) / (pitch * pitch);
  return 1.01 * std::min(std::sqrt(area_cells / (2 * kPi)), boundary / (2 * kPi)) + 1;
}

/// All passages sorted; one that two blocks found at their common face stands once.
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
  parallel_for(static_cast<std::size_t>(rows), 16, [&](std::size_t first, std::size_t last) {
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

  const Search::Rounded rounded = [&](int row, int column, double z) {
    return static_cast<int>(std::lround(boundary_winding(loops, projection, pitch, row, column, base + z * pitch)));
  };
  // Level by level down to blocks enough for all threads, then each block alone.
  struct Task {
    Block block;
    Tangent tangent;
    std::shared_ptr<const Surroundings> within;
    std::vector<Passage> found;
    std::vector<Task> parts;
  };
  const Block whole{0, grid.nu(), 0, grid.nv(), bottom, top};
  const double radius = glm::length(whole.half());
  std::vector<Task> tasks(1);
  tasks[0] = {whole, {}, std::make_shared<Surroundings>(Descent(pieces).root(whole.centre(), radius)), {}, {}};
  bool divisible = true;
  for (double begin = 0; divisible && tasks.size() < kTasks && !tasks.empty(); begin += 0.02) {
    divisible = false;
    parallel_for(
        tasks.size(), 1,
        [&](std::size_t k, std::size_t) {
          Task& task = tasks[k];
          Search search(pieces, rounded, grid, task.found);
          auto around = std::make_shared<Surroundings>();
          search.enter(task.block, *task.within, *around);
          search.parts(task.block, *around,
                       [&](const Block& b, const Tangent& t) { task.parts.push_back({b, t, around, {}, {}}); });
        },
        part(progress, begin, begin + 0.02));
    std::vector<Task> next;
    for (Task& task : tasks)
      for (Task& inner : task.parts) {
        divisible |= !inner.block.within(kLeaf);
        next.push_back(std::move(inner));
      }
    tasks = std::move(next);
  }
  parallel_for(
      tasks.size(), 1,
      [&](std::size_t k, std::size_t) {
        Search(pieces, rounded, grid, tasks[k].found).block(tasks[k].block, tasks[k].tangent, *tasks[k].within);
      },
      part(progress, 0.3, 1));
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
