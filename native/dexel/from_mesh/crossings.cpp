#include "dexel/from_mesh/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "riffler/base/bulk.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::dexel {

namespace {

constexpr int kLatticeBits = 30;         // per cell, at most
constexpr std::uint32_t kInserted = 32;  // up to this many crossings of a column, insertion sort is fastest
constexpr int kCoordinateBits = 50;      // for a whole coordinate, so that products of differences fit 128-bit integers
__extension__ typedef __int128 Wide;

/// ⌈x⌉ clamped to [0, n].
int ceiling(double x, int n) {
  if (!(x > 0)) return 0;
  if (x > n) return n;
  const int k = static_cast<int>(x);
  return k + (x > k);
}

/// Positions of the rays at the upper side of a box that is `extent` cells wide.
struct Aside {
  double ray = 0.5;  // the first ray, cells from the box's lower side
  double side = -1;  // the box's upper side, if a ray lies on it
  double step = 0;

  Aside(double extent, int rays, double lattice) : step(1 / lattice) {
    const double beyond = rays - 0.5 - extent;  // of the last ray
    if (rays == 1 && beyond >= 0)
      ray = extent / 2;
    else if (std::abs(beyond) < step)
      side = rays - 1;
  }
  /// Moves a coordinate on that side just beyond it.
  double operator()(double place) const { return place == side ? place + step : place; }
};

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
    throw std::invalid_argument("pitch is too fine for so large a mesh: its vertices lie 2^50 cells or more away");
  lattice_ = std::ldexp(1.0, std::min(kLatticeBits, kCoordinateBits - bits));
  slack_ = std::ldexp(reach, -48);

  // The last rays may lie on the box's side or, a lone one, beyond it. They count as inside.
  const Aside aside_u(grid.box().size().x / pitch, nu_, lattice_), aside_v(grid.box().size().y / pitch, nv_, lattice_);
  vertices_.resize(mesh.vertices.size());
  base::parallel_for(vertices_.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    // Adding and subtracting 1.5 · 2^52 rounds to integers, faster than a library call.
    constexpr double kRound = 6755399441055744.0;
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3 p = to_local(axis, mesh.vertices[k]);
      const double u = aside_u((((p.x - u0) / pitch - aside_u.ray) * lattice_ + kRound - kRound) / lattice_);
      const double v = aside_v((((p.y - v0) / pitch - aside_v.ray) * lattice_ + kRound - kRound) / lattice_);
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

Bands::Bands(const Mesh& mesh, const Projection& projection, int rows_per_band) : rows_(rows_per_band) {
  const std::size_t bands = static_cast<std::size_t>((projection.nu() + rows_ - 1) / rows_);
  const std::size_t n = mesh.triangles.size();
  // Counts and fills in chunks that do not depend on the number of threads, so the order is the mesh's.
  const std::size_t grain = std::max<std::size_t>(1 << 14, n / 64 + 1), chunks = (n + grain - 1) / grain;
  std::vector<std::size_t> places(chunks * bands, 0);

  // First band and number of bands of each triangle, computed once.
  struct Reach {
    std::int32_t first, count;
  };
  base::BulkVector<Reach> reaches(n);
  base::parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t kAhead = 16;
    std::size_t* place = places.data() + begin / grain * bands;
    for (std::size_t t = begin; t < end; ++t) {
      if (t + kAhead < n) projection.prefetch(mesh.triangles[t + kAhead]);
      const Vec3i& corners = mesh.triangles[t];
      const auto &a = projection.vertex(corners.x), &b = projection.vertex(corners.y),
                 &c = projection.vertex(corners.z);
      const int low = std::min({a.row, b.row, c.row}), high = std::max({a.row, b.row, c.row});
      const bool none = (low == high) | ((a.column == b.column) & (b.column == c.column));
      const int first = low / rows_;
      reaches[t] = {first, none ? 0 : (high - 1) / rows_ - first + 1};
      for (int k = 0; k < reaches[t].count; ++k) ++place[first + k];
    }
  });
  begin_.assign(bands + 1, 0);
  std::size_t total = 0;
  for (std::size_t band = 0; band < bands; ++band) {
    begin_[band] = total;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) total += std::exchange(places[chunk * bands + band], total);
  }
  begin_[bands] = total;
  triangles_.resize(total);
  base::parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    std::size_t* place = places.data() + begin / grain * bands;
    for (std::size_t t = begin; t < end; ++t)
      for (int k = 0; k < reaches[t].count; ++k)
        triangles_[place[reaches[t].first + k]++] = static_cast<std::uint32_t>(t);
  });
}

void BandCrossings::grow(std::size_t more) {
  const std::size_t size = 2 * z_.size() + more;
  z_.resize(size), names_.resize(size);
}

void sort_by_column(const BandCrossings& crossings, std::size_t columns, std::vector<Crossing>& sorted,
                    std::vector<std::uint32_t>& begin) {
  begin.assign(columns + 1, 0);
  const std::size_t n = crossings.size();
  for (std::size_t k = 0; k < n; ++k) ++begin[crossings.column(k) + 1];
  for (std::size_t k = 0; k < columns; ++k) begin[k + 1] += begin[k];
  sorted.resize(n);
  // Filling moves each begin to its end, the next column's begin; the loop below shifts them back.
  for (std::size_t k = 0; k < n; ++k) sorted[begin[crossings.column(k)]++] = crossings[k];
  for (std::size_t k = columns; k > 0; --k) begin[k] = begin[k - 1];
  begin[0] = 0;
  const auto before = [](const Crossing& a, const Crossing& b) {
    return (a.z < b.z) | ((a.z == b.z) & (a.source < b.source));
  };
  for (std::size_t k = 0; k < columns; ++k) {
    const std::uint32_t from = begin[k], to = begin[k + 1];
    if (to - from == 2) {  // most columns; sorted without an unpredictable branch
      const Crossing a = sorted[from], b = sorted[from + 1];
      const bool swap = before(b, a);
      sorted[from + swap] = a, sorted[from + !swap] = b;
      continue;
    }
    if (to - from > kInserted) {
      std::sort(sorted.begin() + from, sorted.begin() + to, before);
      continue;
    }
    for (std::uint32_t i = from + 1; i < to; ++i) {
      const Crossing c = sorted[i];
      std::uint32_t j = i;
      for (; j > from && before(c, sorted[j - 1]); --j) sorted[j] = sorted[j - 1];
      sorted[j] = c;
    }
  }
}

}  // namespace riffler::dexel
