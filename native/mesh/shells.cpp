// Finds the nesting with vertical rays from a few samples of each shell. The samples are binned by x and y, so that
// each triangle is tested only against the samples below and above it.
#include "mesh/shells.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/functions.hpp"

namespace riffler::mesh {

namespace {

/// Volume that rounding may leave of a shell without volume, as a fraction of its box's volume.
constexpr double kFlat = 1e-12;

struct Extent {
  Box3 box;
  double volume = 0;             // signed, mm³
  std::array<int, 6> extreme{};  // triangles at the sides of the box
  int middle = 0;                // index of one more triangle
  std::size_t triangles = 0;
};

bool within(const Box3& a, const Box3& b) {
  for (int k = 0; k < 3; ++k)
    if (a.lower[k] < b.lower[k] || a.upper[k] > b.upper[k]) return false;
  return true;
}

std::vector<Extent> extents(const Mesh& mesh, std::span<const int> shell, std::span<const int> runs,
                            std::size_t count) {
  std::vector<Extent> out(count);
  std::vector<double> sizes(count);
  for (std::size_t t = 0; t < shell.size(); ++t) {
    if (shell[t] < 0) continue;
    Extent& e = out[shell[t]];
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = mesh.vertices[mesh.triangles[t][k]];
      for (int a = 0; a < 3 && e.triangles > 0; ++a) {
        if (p[a] < e.box.lower[a]) e.extreme[2 * a] = static_cast<int>(t);
        if (p[a] > e.box.upper[a]) e.extreme[2 * a + 1] = static_cast<int>(t);
      }
      if (e.triangles == 0 && k == 0) e.extreme.fill(static_cast<int>(t));
      e.box.add(p);
    }
    if (std::has_single_bit(++e.triangles)) e.middle = static_cast<int>(t);
  }
  for (std::size_t t = 0; t < shell.size(); ++t) {
    if (shell[t] < 0) continue;
    Extent& e = out[shell[t]];
    const Vec3 centre = 0.5 * (e.box.lower + e.box.upper);
    const Vec3i& v = mesh.triangles[t];
    const Vec3 a = mesh.vertices[v.x] - centre, b = mesh.vertices[v.y] - centre, c = mesh.vertices[v.z] - centre;
    e.volume += runs[t] * glm::dot(a, glm::cross(b, c)) / 6;
  }
  return out;
}

struct Sample {
  Vec3 p;
  int shell;
};

/// Samples near the corners of each shell's extreme triangles and inside its middle triangle: points without symmetry,
/// slightly behind the surface.
std::vector<Sample> samples(const Mesh& mesh, std::span<const int> runs, const std::vector<Extent>& shells) {
  std::vector<Sample> out;
  for (std::size_t s = 0; s < shells.size(); ++s) {
    const Extent& e = shells[s];
    if (e.volume == 0) continue;
    std::vector<int> chosen(e.extreme.begin(), e.extreme.end());
    chosen.push_back(e.middle);
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const int t : chosen) {
      const Vec3i& v = mesh.triangles[t];
      std::array<Vec3, 3> p{mesh.vertices[v.x], mesh.vertices[v.y], mesh.vertices[v.z]};
      const Vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
      const double area = glm::length(across);
      if (!(area > 0)) continue;
      // The corner farthest from the middle of the shell's box has the largest weight.
      const Vec3 centre = 0.5 * (e.box.lower + e.box.upper);
      std::sort(p.begin(), p.end(),
                [&](const Vec3& a, const Vec3& b) { return glm::length(a - centre) > glm::length(b - centre); });
      const Vec3 out_of = across * ((e.volume > 0 ? runs[t] : -runs[t]) / area);
      const double behind = 1e-6 * std::min(std::sqrt(area), glm::length(e.box.size()));
      out.push_back({0.9301 * p[0] + 0.0418 * p[1] + 0.0281 * p[2] - behind * out_of, static_cast<int>(s)});
    }
  }
  return out;
}

/// Samples in squares of the xy plane, about two per square.
class Squares {
 public:
  explicit Squares(const std::vector<Sample>& samples) {
    for (const Sample& s : samples) box_.add(s.p);
    const double sides = std::max(1.0, std::sqrt(static_cast<double>(samples.size()) / 2));
    side_ = std::max({box_.size().x, box_.size().y, 1e-300}) / sides;
    n_ = {place(box_.upper.x, 0) + 1, place(box_.upper.y, 1) + 1};
    begin_.assign(static_cast<std::size_t>(n_[0]) * n_[1] + 1, 0);
    for (const Sample& s : samples) ++begin_[square(s.p) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    order_.resize(samples.size());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t k = 0; k < samples.size(); ++k) order_[next[square(samples[k].p)]++] = static_cast<int>(k);
  }

  /// Calls visit(sample) for the samples in the squares that a box touches.
  template <class Visit>
  void in(const Box3& box, const Visit& visit) const {
    if (box.upper.x < box_.lower.x || box.lower.x > box_.upper.x || box.upper.y < box_.lower.y ||
        box.lower.y > box_.upper.y)
      return;
    const int i1 = place(box.upper.x, 0), j0 = place(box.lower.y, 1), j1 = place(box.upper.y, 1);
    for (int i = place(box.lower.x, 0); i <= i1; ++i) {
      const std::size_t row = static_cast<std::size_t>(i) * n_[1];
      for (std::size_t k = begin_[row + j0]; k < begin_[row + j1 + 1]; ++k) visit(order_[k]);
    }
  }

 private:
  int place(double x, int axis) const {
    const double at = (std::clamp(x, box_.lower[axis], box_.upper[axis]) - box_.lower[axis]) / side_;
    return static_cast<int>(at);
  }
  std::size_t square(const Vec3& p) const { return static_cast<std::size_t>(place(p.x, 0)) * n_[1] + place(p.y, 1); }

  Box3 box_;
  double side_ = 1;
  std::array<int, 2> n_{};
  std::vector<std::size_t> begin_;
  std::vector<int> order_;
};

/// Whether q lies left of the line from a to b, seen from above; consistent for both triangles of an edge.
bool is_left(const Mesh& mesh, int a, int b, const Vec3& q) {
  const bool swap = a > b;
  const Vec3 &from = mesh.vertices[swap ? b : a], &to = mesh.vertices[swap ? a : b];
  return ((to.x - from.x) * (q.y - from.y) - (to.y - from.y) * (q.x - from.x) >= 0) != swap;
}

/// +1 or −1, by the triangle's orientation, if the vertical line through q meets the triangle above q; otherwise 0.
int crossing_above(const Mesh& mesh, const Vec3i& t, const Vec3& q) {
  const bool left = is_left(mesh, t.x, t.y, q);
  if (is_left(mesh, t.y, t.z, q) != left || is_left(mesh, t.z, t.x, q) != left) return 0;
  const Vec3& a = mesh.vertices[t.x];
  const Vec3 n = glm::cross(mesh.vertices[t.y] - a, mesh.vertices[t.z] - a);
  const double height = glm::dot(n, q - a);  // n.z times the height of q above the plane
  return left ? (height < 0 ? 1 : 0) : (height > 0 ? -1 : 0);
}

/// For each shell, the shells that contain it. Only shells with volume count.
class Nesting {
 public:
  Nesting(const Mesh& mesh, std::span<const int> shell, std::span<const int> runs, const std::vector<Extent>& shells)
      : around_(shells.size()) {
    const std::vector<Sample> points = samples(mesh, runs, shells);
    std::vector<int> wanted(shells.size(), 0);
    for (const Sample& s : points) ++wanted[s.shell];
    if (points.empty()) return;
    const Squares squares(points);
    std::vector<std::tuple<int, int, int>> hits;  // containing shell, sample, crossings
    for (std::size_t t = 0; t < shell.size(); ++t) {
      const int s = shell[t];
      if (s < 0 || shells[s].volume == 0) continue;
      Box3 box;
      for (int k = 0; k < 3; ++k) box.add(mesh.vertices[mesh.triangles[t][k]]);
      squares.in(box, [&](int k) {
        const Extent &inner = shells[points[k].shell], &outer = shells[s];
        if (points[k].shell == s || !(std::abs(outer.volume) > std::abs(inner.volume) * (1 + 1e-9)) ||
            !within(inner.box, outer.box))
          return;
        if (const int sign = crossing_above(mesh, mesh.triangles[t], points[k].p))
          hits.emplace_back(s, k, runs[t] * sign);
      });
    }
    std::sort(hits.begin(), hits.end());
    std::vector<std::pair<int, int>> inside;  // inner, outer: once per sample
    for (std::size_t k = 0; k < hits.size();) {
      const auto [outer, sample, first] = hits[k];
      int sum = 0;
      for (; k < hits.size() && std::get<0>(hits[k]) == outer && std::get<1>(hits[k]) == sample; ++k)
        sum += std::get<2>(hits[k]);
      if (sum != 0) inside.emplace_back(points[sample].shell, outer);
    }
    std::sort(inside.begin(), inside.end());
    for (std::size_t k = 0, end; k < inside.size(); k = end) {
      for (end = k; end < inside.size() && inside[end] == inside[k]; ++end) {
      }
      if (static_cast<int>(end - k) == wanted[inside[k].first]) around_[inside[k].first].push_back(inside[k].second);
    }
  }

  const std::vector<int>& around(int shell) const { return around_[shell]; }

 private:
  std::vector<std::vector<int>> around_;
};

}  // namespace

std::vector<ShellSide> shell_sides(const Mesh& mesh, std::span<const int> shell, std::span<const int> runs,
                                   std::span<const std::uint8_t> open_to_either) {
  const std::size_t count = open_to_either.size();
  std::vector<Extent> shells = extents(mesh, shell, runs, count);
  std::vector<ShellSide> out(count);
  bool inwards = false, outwards = false, either = false;
  for (std::size_t s = 0; s < count; ++s) {
    Extent& e = shells[s];
    const Vec3 size = e.box.size();
    if (std::abs(e.volume) <= kFlat * base::pow(std::max({size.x, size.y, size.z}), 3)) e.volume = 0;
    out[s].volume = std::abs(e.volume);  // 0 without volume
    if (e.volume == 0) continue;
    (open_to_either[s] ? either : e.volume < 0 ? inwards : outwards) = true;
  }
  if (!inwards && !either) return out;
  if (!outwards && !either) {
    for (std::size_t s = 0; s < count; ++s) out[s].turn = shells[s].volume < 0;
    return out;
  }
  const Nesting nesting(mesh, shell, runs, shells);
  std::vector<int> order(count), turned(count, 1), final(count, 0);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return out[a].volume > out[b].volume; });
  for (const int s : order) {
    const Extent& e = shells[s];
    if (e.volume == 0) continue;
    const int given = e.volume > 0 ? 1 : -1;
    int inner = -1, material = 0;
    for (const int k : nesting.around(s)) {
      material += final[k];
      if (inner < 0 || out[k].volume < out[inner].volume) inner = k;
    }
    int side = open_to_either[s] ? -1 : given * (inner < 0 ? 1 : turned[inner]);
    if (side < 0 && material < 1) side = 1;
    final[s] = side;
    // Shells inside a shell without orientation of its own are not turned with it.
    turned[s] = open_to_either[s] ? 1 : side * given;
    out[s].turn = side != given;
  }
  return out;
}

}  // namespace riffler::mesh
