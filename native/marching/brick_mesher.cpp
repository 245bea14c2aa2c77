#include <bit>

#include "marching/neighbourhood.hpp"
#include "marching/plain_brick.hpp"
#include "marching/surface.hpp"
#include "marching/vertices.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::marching {

namespace {

/// Whether a triangle of a quad may fold onto a neighbour's. If two triangles with the normals n and −n share an edge,
/// each faces the side of its own lattice edge, e or f: n·e > 0 and n·f < 0, or vice versa. So one of them is nearly
/// edge-on to its side, or the other faces away from it. `sides`: bits 2 axis + (faces down) of the edges in the
/// corners' cycles.
bool may_fold(const Quad& quad, int diagonal, int sides) {
  constexpr double kEdgeOn = 0.35, kAway = -0.25;
  const auto& c = quad.corner;
  const Vec3 normals[2] = {diagonal == 1 ? glm::cross(c[1] - c[0], c[3] - c[0]) : glm::cross(c[1] - c[0], c[2] - c[0]),
                           diagonal == 1 ? glm::cross(c[2] - c[1], c[3] - c[1]) : glm::cross(c[2] - c[0], c[3] - c[0])};
  for (const Vec3& n : normals) {
    const double length = glm::length(n);
    if (!(quad.side * n[quad.axis] > kEdgeOn * length)) return true;
    for (int a = 0; a < 3; ++a)
      if ((sides >> (2 * a) & 1 && n[a] < kAway * length) || (sides >> (2 * a) & 2 && -n[a] < kAway * length))
        return true;
  }
  return false;
}

/// The vertex numbers in a column of cells of a brick or of the layer below it, K ascending.
class ColumnNumbers {
 public:
  ColumnNumbers(const Bricks& bricks, const Vec3i& at, int i, int j) : column_{i & 31, j & 31} {
    const int a = at.x - (i < 0), b = at.y - (j < 0);
    const ActiveBrick* const here = bricks.active(a, b, at.z);
    below_ = bricks.active(a, b, at.z - 1);
    if (here) next_ = static_cast<std::int32_t>(here->vertex(column_[0], column_[1]));
  }
  /// The first vertex number of the next cell.
  std::int32_t take(int k, int cycles) {
    if (k < 0) return static_cast<std::int32_t>(below_->vertex_after(column_[0], column_[1])) - cycles;
    next_ += cycles;
    return next_ - cycles;
  }

 private:
  int column_[2];
  const ActiveBrick* below_;
  std::int32_t next_ = 0;
};

/// Makes the vertices and quads of one brick. It processes the cells −1 … 31 along each axis: its own, and the layer
/// below that its quads also need. The neighbours place the vertices of that layer, with the same code from the same
/// hits.
class BrickMesher {
 public:
  explicit BrickMesher(Surface& surface) : surface_(surface), finder_(surface.hits), table_(case_table()) {}

  void mesh(ActiveBrick& brick) {
    brick.specials.clear(), brick.suspects.clear(), brick.pulled.clear();
    const Neighbourhood signs(surface_.bricks, brick.at);
    brick_ = &brick, signs_ = &signs;
    origin_ = brick.at * kBrickSide;
    find_hits();
    brick.plain = plain_face();
    brick.hollow = surface_.hollow && brick.plain;
    place_cells();
    split_quads();
  }

 private:
  static constexpr int kSide = kBrickSide + 2;  // columns −1 … 32 of points
  // Bits of a Neighbourhood's words: the points −1 … 32, and those that are lower ends of cells or edges.
  static constexpr std::uint64_t kPoints = ((std::uint64_t{1} << 34) - 1) << 1, kLower = kPoints >> 1 & kPoints;

  static constexpr std::uint8_t kUneven = 64;

  static int column(int i, int j) { return (i + 1) * kSide + j + 1; }

  /// The edge along an axis whose lower end is bit `b` of a column's word.
  LatticeEdge edge(int axis, int i, int j, int b) const {
    return {axis, origin_.x + i, origin_.y + j, origin_.z + b - Neighbourhood::kLayers,
            !(signs_->column(i, j) >> b & 1)};
  }

  void find_hits() {
    hits_.clear();
    for (int i = -1; i <= kBrickSide; ++i)
      for (int j = -1; j <= kBrickSide; ++j) {
        for (int axis = 0; axis < 3; ++axis) {
          const bool within = axis == 2 || (axis == 0 ? i : j) < kBrickSide;
          const std::uint64_t crossed = within ? signs_->crossed(axis, i, j) & (axis == 2 ? kLower : kPoints) : 0;
          crossed_[axis][column(i, j)] = crossed;
          start_[axis][column(i, j)] = static_cast<std::uint32_t>(hits_.size());
          for (std::uint64_t rest = crossed; rest; rest &= rest - 1) {
            hits_.push_back(finder_(edge(axis, i, j, std::countr_zero(rest))));
          }
        }
      }
    corners_.resize(hits_.size());
  }

  /// The brick's plane if it is plain: see plain_brick.hpp.
  std::optional<PlainFace> plain_face() const {
    // As many edges as vertices, and all of them in one layer: no other edges and vertices are left.
    if (brick_->edges() != kBrickColumns || brick_->vertices() != kBrickColumns) return std::nullopt;
    std::optional<PlainFace> face;
    for (int i = 0; i < kBrickSide; ++i)
      for (int j = 0; j < kBrickSide; ++j)
        for (int axis = 0; axis < 3; ++axis) {
          const std::uint64_t crossed = crossed_[axis][column(i, j)], own = crossed & Neighbourhood::kOwn;
          if (own == 0) continue;
          const int k = std::countr_zero(own) - Neighbourhood::kLayers;
          std::uint32_t e = start_[axis][column(i, j)] +
                            static_cast<std::uint32_t>(std::popcount(crossed & (Neighbourhood::kFirstOwn - 1)));
          const int layer = axis == 0 ? i : axis == 1 ? j : k;
          const bool rising = !(signs_->column(i, j) >> (k + Neighbourhood::kLayers) & 1);
          if (!face) face = PlainFace{axis, layer, hits_[e].place, rising};
          // A vertex of the last layer belongs to what the next brick shares.
          if (axis != face->axis || layer != face->layer || layer == kBrickSide - 1 || rising != face->rising ||
              own != (axis == 2 ? own & -own : Neighbourhood::kOwn))
            return std::nullopt;
          for (std::uint64_t rest = own; rest; rest &= rest - 1, ++e)
            if (!lies_in(*face, hits_[e])) return std::nullopt;
        }
    return face;
  }
  static bool lies_in(const PlainFace& face, const Hit& hit) {
    std::array<float, 3> normal{0, 0, 0};
    normal[face.axis] = face.rising ? -1.0F : 1.0F;
    return hit.place == face.place && hit.place >= 0 && hit.place <= 1 && hit.normal == normal;
  }

  /// Whether a cell's vertices are left out.
  bool is_left_out(int i, int j, int k) const {
    if (!brick_->hollow || i < 0 || j < 0 || k < 0) return false;
    return brick_->plain->axis == 0   ? !has_hollow_vertex(j, k)
           : brick_->plain->axis == 1 ? !has_hollow_vertex(i, k)
                                      : !has_hollow_vertex(i, j);
  }

  void place_cells() {
    places_.clear(), numbers_.clear(), sides_.clear();
    for (int i = -1; i < kBrickSide; ++i)
      for (int j = -1; j < kBrickSide; ++j) {
        // A column across the plane has one vertex.
        if (brick_->hollow && brick_->plain->axis == 2 && is_left_out(i, j, 0)) continue;
        if (const std::uint64_t mixed = signs_->mixed(i, j) & kLower) place_column(i, j, mixed);
      }
  }

  void place_column(int i, int j, std::uint64_t mixed) {
    // Each edge of a cell that starts in its lower layer of points has a cursor; those of the upper layer come next in
    // the same column.
    static constexpr int lower[8] = {0, 1, 4, 6, 8, 9, 10, 11};
    ColumnNumbers numbers(surface_.bricks, brick_->at, i, j);
    std::uint32_t cursor[8] = {start_[0][column(i, j)],     start_[0][column(i, j + 1)],    start_[1][column(i, j)],
                               start_[1][column(i + 1, j)], start_[2][column(i, j)],        start_[2][column(i + 1, j)],
                               start_[2][column(i, j + 1)], start_[2][column(i + 1, j + 1)]};
    for (; mixed; mixed &= mixed - 1) {
      const int k = std::countr_zero(mixed) - Neighbourhood::kLayers;
      if (is_left_out(i, j, k)) {
        // One vertex, and the two edges of the lower layer that run along the plane's axis.
        numbers.take(k, 1);
        if (const int axis = brick_->plain->axis; axis < 2) ++cursor[2 * axis], ++cursor[2 * axis + 1];
        continue;
      }
      const CellCase& entry = signs_->entry(table_, i, j, k);
      const int crossed = entry.crossed;
      const std::uint32_t edge[12] = {cursor[0],
                                      cursor[1],
                                      cursor[0] + (crossed & 1),
                                      cursor[1] + (crossed >> 1 & 1),
                                      cursor[2],
                                      cursor[2] + (crossed >> 4 & 1),
                                      cursor[3],
                                      cursor[3] + (crossed >> 6 & 1),
                                      cursor[4],
                                      cursor[5],
                                      cursor[6],
                                      cursor[7]};
      const bool own = i >= 0 && j >= 0 && k >= 0;
      const std::int32_t number = numbers.take(k, entry.cycles);
      siblings_.places.clear(), siblings_.left = false;
      for (int c = 0; c < entry.cycles; ++c) place_cycle(origin_ + Vec3i(i, j, k), entry, c, edge, number + c, own);
      for (int n = 0; n < 8; ++n) cursor[n] += static_cast<std::uint32_t>(crossed >> lower[n] & 1);
    }
  }

  void place_cycle(const Vec3i& cell, const CellCase& entry, int c, const std::uint32_t* edge, std::int32_t number,
                   bool own) {
    const auto local = static_cast<std::uint32_t>(places_.size());
    std::uint8_t sides = 0;
    CycleSums sums;
    for (int n = entry.begin[c]; n < entry.begin[c + 1]; ++n) {
      const CellEdge& shape = kEdges[entry.edge[n]];
      const std::uint32_t e = edge[entry.edge[n]];
      const bool rising = !(entry.code >> shape.low & 1);
      corners_[e][corner_at(shape.slot, rising)] = local;
      sides = static_cast<std::uint8_t>(sides | 1 << (2 * shape.axis + rising));
      sums.add(entry.edge[n], hits_[e]);
    }
    Placed placed;
    if (Vec3 x; entry.cycles == 1 &&
                sums.smooth(entry, c, [&](int n) -> const Hit& { return hits_[edge[entry.edge[n]]]; }, x)) [[likely]]
      placed.place = surface_.grid.inside(cell, x);
    else
      placed = place_uneven(cell, entry, c, edge);
    places_.push_back(placed.place), numbers_.push_back(number);
    sides_.push_back(placed.marks ? static_cast<std::uint8_t>(sides | kUneven) : sides);
    if (!own) return;
    surface_.mesh.vertices[number] = placed.place;
    surface_.marks[number] = placed.marks;
    if (placed.marks & kSpecial) {
      const Vec3& safe = placed.place;
      brick_->specials.push_back({{number, cell}, safe, placed.other, placed.anchor, safe, safe, entry.cycles == 1});
    }
  }

  Placed place_uneven(const Vec3i& cell, const CellCase& entry, int c, const std::uint32_t* edge) {
    Cycle cycle{cell, entry, c, {}};
    for (int n = entry.begin[c], m = 0; n < entry.begin[c + 1]; ++n, ++m) cycle.hits[m] = &hits_[edge[entry.edge[n]]];
    const Placed placed = place_vertex(surface_.grid, cycle, siblings_);
    if (entry.cycles > 1) siblings_.places.push_back(placed.place);
    siblings_.left |= (placed.marks & kCandidate) != 0;
    return placed;
  }

  void split_quads() {
    const double tie = diagonal_tie(surface_.lattice);
    std::size_t quad = brick_->first_edge;
    for (int i = 0; i < kBrickSide; ++i)
      for (int j = 0; j < kBrickSide; ++j)
        for (int axis = 0; axis < 3; ++axis) {
          const std::uint64_t crossed = crossed_[axis][column(i, j)];
          std::uint32_t e = start_[axis][column(i, j)] +
                            static_cast<std::uint32_t>(std::popcount(crossed & (Neighbourhood::kFirstOwn - 1)));
          for (std::uint64_t rest = crossed & Neighbourhood::kOwn; rest; rest &= rest - 1, ++e, ++quad) {
            const auto n = static_cast<int>(quad - brick_->first_edge);
            if (brick_->hollow && !has_hollow_quad(n / kBrickSide, n % kBrickSide)) continue;
            split(quad, e, edge(axis, i, j, std::countr_zero(rest)), tie);
          }
        }
  }

  void split(std::size_t quad, std::uint32_t e, const LatticeEdge& edge, double tie) {
    Quad shape{{}, edge.axis, edge.rising ? -1.0 : 1.0};
    std::array<std::int32_t, 4> numbers;
    int sides = 0;
    for (int n = 0; n < 4; ++n) {
      const std::uint32_t corner = corners_[e][n];
      shape.corner[n] = places_[corner], numbers[n] = numbers_[corner];
      sides |= sides_[corner];
    }
    const int diagonal = choose_diagonal(shape, surface_.place_of(edge, hits_[e]), tie);
    surface_.write(quad, numbers, diagonal);
    if (sides & kUneven && may_fold(shape, diagonal, sides))
      brick_->suspects.push_back({static_cast<std::uint32_t>(quad), edge});
  }

  Surface& surface_;
  HitFinder finder_;
  const CaseTable& table_;
  ActiveBrick* brick_ = nullptr;
  const Neighbourhood* signs_ = nullptr;
  Vec3i origin_{0};  // first point of the brick
  // For the edges of all these cells, by column, axis and K:
  std::array<std::array<std::uint64_t, kSide * kSide>, 3> crossed_;
  std::array<std::array<std::uint32_t, kSide * kSide>, 3> start_;
  std::vector<Hit> hits_;
  std::vector<std::array<std::uint32_t, 4>> corners_;  // for the quads around them, as indices into the next two arrays
  std::vector<Vec3> places_;
  std::vector<std::int32_t> numbers_;
  std::vector<std::uint8_t> sides_;  // sides that the cycle's edges face; kUneven if triangles may fold
  Siblings siblings_;
};

/// Writes new vertex numbers into the quads of a brick. Until all are written they are stored negated: equal numbers
/// identify a quad's diagonal, and a new number may equal an old one.
class Linker {
 public:
  Linker(Surface& surface, const Vec3i& brick) : surface_(surface), origin_(brick * kBrickSide) {}

  /// Writes the vertex of a cycle into those of its quads that belong to the brick's own edges.
  void link(const Vec3i& cell, const CellCase& entry, int c, std::int32_t number) {
    for (int n = entry.begin[c]; n < entry.begin[c + 1]; ++n) {
      const CellEdge& shape = kEdges[entry.edge[n]];
      const Vec3i from = cell + Vec3i(shape.from[0], shape.from[1], shape.from[2]);
      if (from.x < 0 || from.y < 0 || from.z < 0) continue;
      if (from.x >= kBrickSide || from.y >= kBrickSide || from.z >= kBrickSide) continue;
      const bool rising = !(entry.code >> shape.low & 1);
      const Vec3i at = origin_ + from;
      const std::uint32_t quad = surface_.bricks.quad_of({shape.axis, at.x, at.y, at.z, rising});
      auto corners = surface_.corners(quad);
      corners[corner_at(shape.slot, rising)] = ~number;
      surface_.write(quad, corners, surface_.diagonal(quad));
      linked_.push_back(quad);
    }
  }
  void finish() {
    for (const std::uint32_t quad : linked_) {
      auto corners = surface_.corners(quad);
      const int diagonal = surface_.diagonal(quad);
      for (std::int32_t& c : corners) c = c < 0 ? ~c : c;
      surface_.write(quad, corners, diagonal);
    }
  }

 private:
  Surface& surface_;
  Vec3i origin_;
  std::vector<std::uint32_t> linked_;
};

}  // namespace

void link_bricks(Surface& surface, const std::vector<std::size_t>& bricks) {
  const CaseTable& table = case_table();
  base::parallel_for(bricks.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Vec3i at = surface.bricks.place(bricks[n]);
      const Neighbourhood signs(surface.bricks, at);
      Linker linker(surface, at);
      for (int i = -1; i < kBrickSide; ++i)
        for (int j = -1; j < kBrickSide; ++j) {
          const std::uint64_t layer = i < 0 || j < 0 ? Neighbourhood::kOwn | Neighbourhood::kOwn >> 1 : 2;
          std::uint64_t mixed = signs.mixed(i, j) & layer;
          ColumnNumbers numbers(surface.bricks, at, i, j);
          for (; mixed; mixed &= mixed - 1) {
            const int k = std::countr_zero(mixed) - Neighbourhood::kLayers;
            const CellCase& entry = signs.entry(table, i, j, k);
            const std::int32_t number = numbers.take(k, entry.cycles);
            for (int c = 0; c < entry.cycles; ++c) linker.link({i, j, k}, entry, c, number + c);
          }
        }
      linker.finish();
    }
  });
}

void mesh_bricks(Surface& surface, const std::vector<std::size_t>& bricks, const Progress& progress) {
  base::parallel_for(
      bricks.size(), 8,
      [&](std::size_t begin, std::size_t end) {
        BrickMesher mesher(surface);
        for (std::size_t n = begin; n < end; ++n) mesher.mesh(*surface.bricks.active(bricks[n]));
      },
      progress);
}

}  // namespace riffler::marching
