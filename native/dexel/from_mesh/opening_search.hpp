// The search for passages through openings, block by block.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <vector>

#include "dexel/from_mesh/boundary_field.hpp"
#include "dexel/from_mesh/field.hpp"
#include "dexel/from_mesh/passage.hpp"
#include "riffler/dexel/grid.hpp"

namespace riffler::dexel {

/// Searches blocks of columns for passages. Lengths in cells.
class OpeningSearch {
 public:
  static constexpr int kLeaf = 4;  ///< columns and cells of the sides of blocks that are not divided, at least

  /// Columns [i0, i1) × [j0, j1) from z0 to z1, in cells.
  struct Block {
    int i0, i1, j0, j1;
    double z0, z1;

    Vec3 centre() const { return {0.5 * (i0 + i1 - 1), 0.5 * (j0 + j1 - 1), 0.5 * (z0 + z1)}; }
    Vec3 half() const { return {0.5 * (i1 - 1 - i0), 0.5 * (j1 - 1 - j0), 0.5 * (z1 - z0)}; }
    bool within(int side) const { return i1 - i0 <= side && j1 - j0 <= side && z1 - z0 <= side; }
  };
  /// K at a block's centre as a phase, with its gradient there, and a bound of how far K in the block may be from that
  /// tangent plane: infinity where an edge may pass through.
  struct Tangent {
    double phase, remainder;
    Vec3 gradient;
  };

  /// K on a column, rounded to an integer, by boundary_winding.
  using Rounded = std::function<int(int row, int column, double z)>;

  OpeningSearch(const BoundaryPieces& pieces, const Rounded& rounded, const Grid& grid, std::vector<Passage>& out)
      : pieces_(pieces), descent_(pieces), rounded_(rounded), grid_(grid), out_(out) {}

  /// Calls body for the parts of a block, whose surroundings are `around`, in which K may pass ½.
  template <class Body>
  void parts(const Block& block, const Surroundings& around, const Body& body) {
    look(block, around);
    parts(block, around.far.curved(block.half()), body);
  }

  /// The surroundings of a block within those of one that holds it.
  void enter(const Block& block, const Surroundings& within, Surroundings& around);
  /// All passages in a block.
  void block(const Block& block, const Tangent& tangent, const Surroundings& within, std::size_t depth = 0);

 private:
  /// Phases are that much in error (polynomials), with room to spare.
  static constexpr double kSlack = 1e-4;

  static constexpr Tangent kNoTangent{0, std::numeric_limits<double>::infinity(), Vec3(0)};

  /// Calls body for the parts of a block, halved along every side longer than half the longest (and than `side`).
  template <class Body>
  static void halves(const Block& b, int side, const Body& body) {
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

  /// The same with the present field, `curved` the polynomial's bound for halves of the block.
  template <class Body>
  void parts(const Block& block, double curved, const Body& body) {
    std::array<Block, kPoints> parts;
    std::size_t count = 0;
    halves(block, kLeaf, [&](const Block& part) {
      if (!outshone(part)) parts[count++] = part;
    });
    if (count == 0) return;
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

  /// Takes up the surroundings of a block that is about to be divided.
  void look(const Block& block, const Surroundings& around);
  /// Whether |K| stays below ½ in a part of the block looked at, if only because the loops near by are seen as small.
  bool outshone(const Block& part) const;
  static void set(FieldPoints& points, std::size_t k, const Block& block);
  static void set(FieldPoints& points, std::size_t k, const Piece& piece, double z);
  /// A block that is searched in its own surroundings to the end.
  void leaf(const Block& block, const Tangent& tangent, const Surroundings& around);
  /// Columns of the leaf's blocks in which K may pass ½, `curved` the polynomial's bound for halves of the block.
  void columns(const Block& block, const Tangent& t, double curved);
  /// Passages on some pieces. One at an end may be found from both sides.
  void segments();
  /// Pieces that second derivatives do not settle.
  void doubts();
  /// One evaluation for the roots of phases whose slopes vary by less than half of themselves.
  void roots();
  /// A step of Newton's method.
  void newton(Root root, double phase, double slope);
  void add(const Piece& piece, double z, bool rising);
  /// Of the passages that have none yet.
  void normals();

  const BoundaryPieces& pieces_;
  Descent descent_;
  const Rounded& rounded_;
  const Grid& grid_;
  std::vector<Passage>& out_;
  std::deque<Surroundings> levels_;  // of the blocks that enclose the present one
  Field field_;
  std::vector<const BoundaryPieces::Surface*> loops_;  // near, where there are no other pieces
  double rest_ = 1;                                    // what they may have of |K| before it may be ½; < 0: unknown
  double curved_ = 0;                                  // of the polynomial along the leaf's columns
  std::vector<Piece> segments_;
  std::vector<Doubt> doubts_;
  std::vector<Root> roots_;
  std::size_t complete_ = 0;  // passages that have their normals
};

}  // namespace riffler::dexel
