// Searches for passages through openings, block by block.
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
  static constexpr int kLeaf = 4;  ///< blocks with sides of up to this many columns and cells are not divided

  /// Columns [i0, i1) × [j0, j1) from z0 to z1, in cells.
  struct Block {
    int i0, i1, j0, j1;
    double z0, z1;

    Vec3 centre() const { return {0.5 * (i0 + i1 - 1), 0.5 * (j0 + j1 - 1), 0.5 * (z0 + z1)}; }
    Vec3 half() const { return {0.5 * (i1 - 1 - i0), 0.5 * (j1 - 1 - j0), 0.5 * (z1 - z0)}; }
    bool within(int side) const { return i1 - i0 <= side && j1 - j0 <= side && z1 - z0 <= side; }
  };
  /// K at a block's centre as a phase, its gradient there, and a bound on the difference between K in the block and
  /// that tangent plane: infinity if an edge may pass through.
  struct Tangent {
    double phase, remainder;
    Vec3 gradient;
  };

  /// K on a column, rounded to an integer by boundary_winding.
  using Rounded = std::function<int(int row, int column, double z)>;

  OpeningSearch(const BoundaryPieces& pieces, const Rounded& rounded, const Grid& grid, std::vector<Passage>& out)
      : pieces_(pieces), descent_(pieces), rounded_(rounded), grid_(grid), out_(out) {}

  /// Calls body for the parts of a block in which K may pass ½; `around` are the block's surroundings.
  template <class Body>
  void parts(const Block& block, const Surroundings& around, const Body& body) {
    look(block, around);
    parts(block, around.far.curved(block.half()), body);
  }

  /// Computes the surroundings of a block from those of an enclosing block.
  void enter(const Block& block, const Surroundings& within, Surroundings& around);
  /// Finds all passages in a block.
  void block(const Block& block, const Tangent& tangent, const Surroundings& within, std::size_t depth = 0);

 private:
  /// Bound on the error of a phase (from the polynomials), with a margin.
  static constexpr double kSlack = 1e-4;

  static constexpr Tangent kNoTangent{0, std::numeric_limits<double>::infinity(), Vec3(0)};

  /// Calls body for the parts of a block, halved along every side that is longer than half the longest side and than
  /// `side`.
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

  /// Same with the current field; `curved` is the polynomial's bound for halves of the block.
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
      // The polynomial's bound holds for parts of half the size along every axis.
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
  /// A piece, and K with its slope at the middle.
  struct Doubt {
    Piece piece;
    double phase, slope;
  };
  /// A piece in which K passes ½ once, with the current position of the search for that place.
  struct Root {
    Piece piece;
    double z;
    bool rising;
    int steps;
  };

  /// Loads the surroundings of a block that is about to be divided.
  void look(const Block& block, const Surroundings& around);
  /// Whether |K| stays below ½ in a part of the current block because the nearby loops appear small enough from there.
  bool outshone(const Block& part) const;
  static void set(FieldPoints& points, std::size_t k, const Block& block);
  static void set(FieldPoints& points, std::size_t k, const Piece& piece, double z);
  /// Searches a block completely in its own surroundings.
  void leaf(const Block& block, const Tangent& tangent, const Surroundings& around);
  /// Finds the columns of the leaf's blocks in which K may pass ½; `curved` is the polynomial's bound for halves of the
  /// block.
  void columns(const Block& block, const Tangent& t, double curved);
  /// Finds passages on several pieces. A passage at the end of a piece may be found from both sides.
  void segments();
  /// Handles pieces that second derivatives do not settle.
  void doubts();
  /// Evaluates the field once for roots of phases whose slopes vary by less than half their value.
  void roots();
  /// One step of Newton's method.
  void newton(Root root, double phase, double slope);
  void add(const Piece& piece, double z, bool rising);
  /// Computes the normals of passages that have none yet.
  void normals();

  const BoundaryPieces& pieces_;
  Descent descent_;
  const Rounded& rounded_;
  const Grid& grid_;
  std::vector<Passage>& out_;
  std::deque<Surroundings> levels_;  // surroundings of the blocks that enclose the current one
  Field field_;
  std::vector<const BoundaryPieces::Surface*> loops_;  // the near loops, if all near pieces are loops
  double rest_ = 1;    // how much they may add to |K| before it may reach ½; < 0: unknown
  double curved_ = 0;  // the polynomial's bound along the leaf's columns
  std::vector<Piece> segments_;
  std::vector<Doubt> doubts_;
  std::vector<Root> roots_;
  std::size_t complete_ = 0;  // number of passages that have normals
};

}  // namespace riffler::dexel
