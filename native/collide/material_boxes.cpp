#include "collide/material_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "riffler/base/parallel.hpp"

namespace riffler::collide {

namespace {

constexpr int kSide = 8;  // cells per side of a brick

}  // namespace

/// A block of cells in the grid's cyclic frame.
class MaterialBoxes::Brick {
 public:
  Brick(const dexel::Grid& grid, int rays, double spacing) : grid_(grid), rays_(rays), spacing_(spacing) {}

  /// Reads the cells from (u, v, w) to (u, v, w) + 8 of the grid.
  void read(int u, int v, int w) {
    cells_ = {};
    const double h = grid_.pitch(), bottom = grid_.box().lower.z + w * spacing_, top = bottom + kSide * spacing_;
    for (int i = u * rays_; i < std::min((u + kSide) * rays_, grid_.nu()); ++i)
      for (int j = v * rays_; j < std::min((v + kSide) * rays_, grid_.nv()); ++j)
        for (const dexel::Span& s : grid_.ray(i, j)) {
          if (s.far <= bottom || s.near >= top) continue;
          const auto layer = [&](double z) { return std::clamp(int((z - bottom) / spacing_), 0, kSide - 1); };
          for (int m = layer(s.near); m <= layer(s.far); ++m) {
            const double low = std::max(s.near, bottom + m * spacing_),
                         high = std::min(s.far, bottom + (m + 1) * spacing_);
            if (!(low < high)) continue;
            Cell& c = cells_[place(i / rays_ - u, j / rays_ - v, m)];
            c.box.add({grid_.u(i) - 0.5 * h, grid_.v(j) - 0.5 * h, low});
            c.box.add({grid_.u(i) + 0.5 * h, grid_.v(j) + 0.5 * h, high});
            c.volume += h * h * (high - low);
          }
        }
    full_ = spacing_ * spacing_ * spacing_ * (1 - 1e-9);
  }
  void gather(std::vector<Piece>& out) const { gather({0, 0, 0}, kSide, out); }

 private:
  struct Cell {
    Box3 box;
    double volume = 0;
  };
  static std::size_t place(int a, int b, int c) { return static_cast<std::size_t>((a * kSide + b) * kSide + c); }

  void gather(const Vec3i& at, int side, std::vector<Piece>& out) const {
    Cell all;
    bool full = true;
    for (int a = at.x; a < at.x + side; ++a)
      for (int b = at.y; b < at.y + side; ++b)
        for (int c = at.z; c < at.z + side; ++c) {
          const Cell& cell = cells_[place(a, b, c)];
          if (cell.volume > 0) all.box.add(cell.box.lower), all.box.add(cell.box.upper);
          all.volume += cell.volume, full &= cell.volume >= full_;
        }
    if (all.volume == 0) return;
    if (full || side == 1) {
      Box3 box;
      box.add(to_world(grid_.axis(), all.box.lower)), box.add(to_world(grid_.axis(), all.box.upper));
      out.push_back({box, all.volume});
      return;
    }
    const int half = side / 2;
    for (int k = 0; k < 8; ++k) gather(at + half * Vec3i(k >> 2, (k >> 1) & 1, k & 1), half, out);
  }

  const dexel::Grid& grid_;
  int rays_;
  double spacing_, full_ = 0;
  std::array<Cell, kSide * kSide * kSide> cells_;
};

double MaterialBoxes::cell_of(const Volume& volume, double spacing) {
  const double h = volume.frame().pitch;
  return h * std::max(1.0, std::round(spacing / h));
}

std::vector<MaterialBoxes::Piece> MaterialBoxes::pieces_of(const Volume& volume, double spacing) {
  const dexel::Grid& grid = volume.reference();
  // If the spacing exceeds the grid, one cell holds all rays.
  const int rays = static_cast<int>(std::min(std::round(spacing / grid.pitch()), 1.0 + std::max(grid.nu(), grid.nv())));
  const auto bricks = [](double cells) { return static_cast<std::size_t>(std::ceil(cells / kSide)); };
  const std::size_t nu = bricks(std::ceil(double(grid.nu()) / rays)), nv = bricks(std::ceil(double(grid.nv()) / rays)),
                    nw = bricks(std::ceil(grid.box().size().z / spacing));
  std::vector<std::vector<Piece>> found(nu * nv);
  base::parallel_for(nu * nv, 1, [&](std::size_t column, std::size_t) {
    Brick brick(grid, rays, spacing);
    for (std::size_t w = 0; w < nw; ++w) {
      brick.read(kSide * static_cast<int>(column / nv), kSide * static_cast<int>(column % nv),
                 kSide * static_cast<int>(w));
      brick.gather(found[column]);
    }
  });
  std::vector<Piece> out;
  for (const std::vector<Piece>& some : found) out.insert(out.end(), some.begin(), some.end());
  return out;
}

MaterialBoxes::MaterialBoxes(const Volume& volume, double spacing)
    : MaterialBoxes(pieces_of(volume, cell_of(volume, spacing)), cell_of(volume, spacing)) {}

MaterialBoxes::MaterialBoxes(const std::vector<Piece>& pieces, double spacing)
    : spacing_(spacing),
      tree_({pieces.size(), [&](std::size_t i) { return pieces[i].box; },
             [&](std::size_t i) {
               const Box3& b = pieces[i].box;
               return BoundingSphere{0.5 * (b.lower + b.upper), 0.5 * glm::length(b.size())};
             },
             [&](std::size_t i, const Vec3& p) {
               const Box3& b = pieces[i].box;
               return glm::length(glm::max(glm::abs(b.lower - p), glm::abs(b.upper - p)));
             },
             [&](std::span<const std::uint32_t> some) {
               const Vec3 first = pieces[some[0]].box.lower;
               Vec3 sum(0);
               double volume = 0;
               for (const std::uint32_t i : some) {
                 const Box3& b = pieces[i].box;
                 sum += pieces[i].volume * (0.5 * (b.lower + b.upper) - first), volume += pieces[i].volume;
               }
               return first + sum / volume;
             }}) {
  boxes_.resize(tree_.groups());
  for (std::size_t g = tree_.groups(); g-- > 0;)
    for (int k = 0; k < base::kLanes; ++k) {
      if (tree_.group(g).radius[k] < 0) continue;
      if (!tree_.holds_items(g)) {
        for (const double v : boxes_[tree_.first_child(g) + static_cast<std::size_t>(k)].volume)
          boxes_[g].volume[k] += v;
      } else {
        const Piece& piece = pieces[tree_.order()[tree_.first_item(g) + static_cast<std::size_t>(k)]];
        for (int i = 0; i < 3; ++i) boxes_[g].half[i][k] = 0.5 * piece.box.size()[i];
        boxes_[g].volume[k] = piece.volume;
      }
    }
}

}  // namespace riffler::collide
