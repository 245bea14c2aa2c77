#include "dexel/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "geom/parallel.hpp"

namespace riffler {

namespace {

constexpr int kLatticeBits = 30;     // of one cell, at most
constexpr int kCoordinateBits = 50;  // of a whole coordinate: products of differences fit 128-bit integers
__extension__ typedef __int128 Wide;

/// ⌈x⌉ clamped to [0, n].
int ceiling(double x, int n) {
  if (!(x > 0)) return 0;
  if (x > n) return n;
  const int k = static_cast<int>(x);
  return k + (x > k);
}

}  // namespace

Projection::Projection(const Mesh& mesh, const Grid& grid) : nu_(grid.nu()), nv_(grid.nv()) {
  const Axis axis = grid.axis();
  const double pitch = grid.pitch(), u0 = grid.box().lower.x, v0 = grid.box().lower.y;
  Box3 box;
  for (const Vec3& p : mesh.vertices) box.add(to_local(axis, p));
  double reach = std::max(nu_, nv_);
  for (const double x : {box.lower.x - u0, box.upper.x - u0, box.lower.y - v0, box.upper.y - v0})
    reach = std::max(reach, std::abs(x) / pitch + 1);
  const int bits = std::ilogb(reach) + 1;
  if (bits > kCoordinateBits)
    throw std::invalid_argument("pitch is too fine for a mesh as large as this: its vertices lie 2^50 cells away");
  lattice_ = std::ldexp(1.0, std::min(kLatticeBits, kCoordinateBits - bits));
  slack_ = std::ldexp(reach, -48);

  vertices_.resize(mesh.vertices.size());
  parallel_for(vertices_.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    // Adding and taking away 1.5 · 2^52 rounds to integers, faster than a library call.
    constexpr double kRound = 6755399441055744.0;
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3 p = to_local(axis, mesh.vertices[k]);
      const double u = (((p.x - u0) / pitch - 0.5) * lattice_ + kRound - kRound) / lattice_;
      const double v = (((p.y - v0) / pitch - 0.5) * lattice_ + kRound - kRound) / lattice_;
      vertices_[k] = {u, v, p.z, ceiling(u, nu_), ceiling(v, nv_)};
    }
  });
}

bool Projection::beyond(const Vertex& low, const Vertex& high, int row, int column) const {
  const auto lattice = [&](double cells) { return static_cast<Wide>(static_cast<std::int64_t>(cells * lattice_)); };
  const Wide left = (lattice(row) - lattice(low.u)) * (lattice(high.v) - lattice(low.v));
  const Wide right = (lattice(column) - lattice(low.v)) * (lattice(high.u) - lattice(low.u));
  return left > right;
}

void Projection::cross(const Vec3i& corners, std::uint32_t triangle, int first, int last,
                       std::vector<BandCrossing>& out) const {
  const Vertex *a = &vertices_[corners.x], *b = &vertices_[corners.y], *c = &vertices_[corners.z];
  // Sorted by u without jumps, which a processor could not foresee.
  int parity = 1;
  const auto order = [&parity](const Vertex*& low, const Vertex*& high) {
    const bool swap = high->u < low->u;
    const Vertex* const lower = swap ? high : low;
    high = swap ? low : high;
    low = lower;
    parity = swap ? -parity : parity;
  };
  order(a, b), order(b, c), order(a, b);

  // The long edge ac against ab, then against bc. Half-open: a row belongs to an edge where u(low) ≤ row < u(high), so
  // that an edge of constant u never counts.
  const double inverse = 1 / (c->u - a->u), slope = (c->v - a->v) * inverse;
  for (const bool upper : {false, true}) {
    const Vertex &low = upper ? *b : *a, &high = upper ? *c : *b;
    int row = std::max(first, low.row);
    const int end = std::min(last, high.row);
    if (row >= end) continue;
    const double inverse_part = 1 / (high.u - low.u), slope_part = (high.v - low.v) * inverse_part;
    for (; row < end; ++row) {
      const double v_whole = a->v + (row - a->u) * slope, v_part = low.v + (row - low.u) * slope_part;
      const int c_whole = column(*a, *c, row, v_whole), c_part = column(low, high, row, v_part);
      if (c_whole == c_part) continue;
      const std::int32_t sign = c_part < c_whole ? -parity : parity;
      const double z_whole = a->z + (row - a->u) * inverse * (c->z - a->z);
      const double z_part = low.z + (row - low.u) * inverse_part * (high.z - low.z);
      const double width = v_part - v_whole, rise = z_part - z_whole;
      const std::uint32_t offset = static_cast<std::uint32_t>(row - first) * static_cast<std::uint32_t>(nv_);
      for (int k = std::min(c_whole, c_part); k < std::max(c_whole, c_part); ++k) {
        const double t = width == 0 ? 0 : std::clamp((k - v_whole) / width, 0.0, 1.0);
        out.push_back({{z_whole + t * rise, triangle, sign}, offset + static_cast<std::uint32_t>(k)});
      }
    }
  }
}

Bands::Bands(const Mesh& mesh, const Projection& projection, int rows_per_band) : rows_(rows_per_band) {
  const std::size_t bands = static_cast<std::size_t>((projection.nu() + rows_ - 1) / rows_);
  const std::size_t n = mesh.triangles.size();
  // Counted and filled in chunks that do not depend on the number of threads, so the order is the mesh's.
  const std::size_t grain = std::max<std::size_t>(1 << 14, n / 64 + 1), chunks = (n + grain - 1) / grain;
  std::vector<std::size_t> places(chunks * bands, 0);

  const auto visit = [&](std::size_t begin, std::size_t end, const auto& body) {
    constexpr std::size_t kAhead = 16;
    for (std::size_t t = begin; t < end; ++t) {
      if (t + kAhead < n) projection.prefetch(mesh.triangles[t + kAhead]);
      const Vec3i& corners = mesh.triangles[t];
      const auto &a = projection.vertex(corners.x), &b = projection.vertex(corners.y),
                 &c = projection.vertex(corners.z);
      if ((a.row == b.row && b.row == c.row) || (a.column == b.column && b.column == c.column)) continue;
      const int from = std::min({a.row, b.row, c.row}) / rows_, to = (std::max({a.row, b.row, c.row}) - 1) / rows_;
      for (int k = from; k <= to; ++k) body(static_cast<std::size_t>(k), static_cast<std::uint32_t>(t));
    }
  };
  parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    std::size_t* place = places.data() + begin / grain * bands;
    visit(begin, end, [&](std::size_t band, std::uint32_t) { ++place[band]; });
  });
  begin_.assign(bands + 1, 0);
  std::size_t total = 0;
  for (std::size_t band = 0; band < bands; ++band) {
    begin_[band] = total;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) total += std::exchange(places[chunk * bands + band], total);
  }
  begin_[bands] = total;
  triangles_.resize(total);
  parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    std::size_t* place = places.data() + begin / grain * bands;
    visit(begin, end, [&](std::size_t band, std::uint32_t t) { triangles_[place[band]++] = t; });
  });
}

void sort_by_column(const std::vector<BandCrossing>& crossings, std::size_t columns, std::vector<Crossing>& sorted,
                    std::vector<std::uint32_t>& begin) {
  begin.assign(columns + 1, 0);
  for (const BandCrossing& c : crossings) ++begin[c.column + 1];
  for (std::size_t k = 0; k < columns; ++k) begin[k + 1] += begin[k];
  sorted.resize(crossings.size());
  // Filling moves each begin to its end, which is the next column's begin; shifted back below.
  for (const BandCrossing& c : crossings) sorted[begin[c.column]++] = c.crossing;
  for (std::size_t k = columns; k > 0; --k) begin[k] = begin[k - 1];
  begin[0] = 0;
  for (std::size_t k = 0; k < columns; ++k)
    for (std::uint32_t i = begin[k] + 1; i < begin[k + 1]; ++i) {
      const Crossing c = sorted[i];
      std::uint32_t j = i;
      for (; j > begin[k] && c.z < sorted[j - 1].z; --j) sorted[j] = sorted[j - 1];
      sorted[j] = c;
    }
}

}  // namespace riffler
