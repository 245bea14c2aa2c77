#include "dexel/field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace riffler {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const FieldSums& sums() {
  static const FieldSums& fastest = FieldSums::available().front();
  return fastest;
}

double wrap(double x) {
  return x - std::round(x);
}

/// Column coordinates relative to the ray. A boundary vertex exactly over or under the ray has no direction to its
/// side; any will do, since it enters both its edges and cancels.
Vec2 aside(double u, double v) {
  constexpr double kNone = 1.0 / (1LL << 36);
  return u == 0 && v == 0 ? Vec2(kNone, 0) : Vec2(u, v);
}

/// A direction in stereographic coordinates up to a positive factor: (t : α) = (t : f α).
struct Stereographic {
  double t, f;
  Stereographic(double z, double rr) {
    const double length = std::sqrt(rr + z * z);
    t = z < 0 ? rr : length + z, f = z < 0 ? length - z : 1.0;
  }
};

/// The phase of K, whose edges' share is `edges` and whose multipoles' share times 4π is `value`.
double phase(const EdgeSum& edges, double value) {
  return wrap(std::atan2(edges.im, edges.re) / (2 * kPi) - 0.5 + value / (4 * kPi));
}

}  // namespace

double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a, r = p - a;
  const double dd = glm::dot(d, d);
  const double t = dd > 0 ? std::clamp(glm::dot(r, d) / dd, 0.0, 1.0) : 0;
  return glm::length(r - t * d);
}

// |∇(dl × r / |r|³)| ≤ 2 |dl| / |r|³, integrated over the edge or over the whole line.
double edge_curvature(double length, double d) {
  if (!(d > 0)) return kInfinity;
  const double inverse = 1 / d;
  return std::min(0.5 * length * inverse, 1.0) * inverse * inverse / kPi;
}

void Field::clear() {
  for (std::vector<double>* v : {&x_, &y_, &z_, &joined_}) v->clear();
  far_.clear(), near_.clear();
  far_curvature_ = 0;
  last_ = -1;
}

void Field::add_point(const Vec3& p, bool begins) {
  x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z), joined_.push_back(begins ? 0 : 1);
}

void Field::add_edge(const std::vector<Vec3>& points, int a, int b) {
  if (last_ != a) add_point(points[a], true);
  add_point(points[b], false);
  last_ = b;
}

void Field::set_column(double u, double v) {
  u_ = u, v_ = v;
  // One point in front of the first group of lanes, and points that no edge leads to behind the last.
  while (z_.size() % kLanes != 1) add_point(Vec3(u + 1, v, 0), true);
  const std::size_t n = z_.size();
  for (std::vector<double>* w : {&ax_, &ay_, &rr_, &dot_, &cross_}) w->resize(n);
  scratch_.resize(4 * n);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 a = aside(x_[k] - u, y_[k] - v);
    ax_[k] = a.x, ay_[k] = a.y, rr_[k] = a.x * a.x + a.y * a.y;
  }
  // Without an edge conj(α) β counts as 0, which leaves the product a positive factor.
  for (std::size_t k = 1; k < n; ++k) {
    dot_[k] = joined_[k] * (ax_[k - 1] * ax_[k] + ay_[k - 1] * ay_[k]);
    cross_[k] = joined_[k] * (ax_[k - 1] * ay_[k] - ay_[k - 1] * ax_[k]);
  }
  set_poles();
}

void Field::set_poles() {
  const std::size_t n = (far_.size() + kLanes - 1) / kLanes * kLanes;
  poles_.assign(8 * n, 0);
  double* array = poles_.data();
  const auto next = [&] { return std::exchange(array, array + n); };
  double *z = next(), *rr = next(), *dz = next(), *across = next(), *flat = next(), *skew = next(), *qzz = next(),
         *trace = next();
  for (std::size_t k = far_.size(); k < n; ++k) rr[k] = 1;
  for (std::size_t k = 0; k < far_.size(); ++k) {
    const Multipole& m = far_[k];
    const double x = m.centre.x - u_, y = m.centre.y - v_;
    z[k] = m.centre.z, rr[k] = x * x + y * y, dz[k] = m.dipole.z, across[k] = m.dipole.x * x + m.dipole.y * y;
    flat[k] = m.quadrupole[0][0] * x * x + 2 * m.quadrupole[0][1] * x * y + m.quadrupole[1][1] * y * y;
    skew[k] = m.quadrupole[0][2] * x + m.quadrupole[1][2] * y;
    qzz[k] = m.quadrupole[2][2], trace[k] = m.trace;
  }
}

Field::Value Field::at(double z) const {
  const EdgeSum edges = sums().edges(edge_arrays(), z, false);
  const std::size_t n = poles_.size() / 8;
  const double* p = poles_.data();
  const PoleSum poles =
      sums().poles({p, p + n, p + 2 * n, p + 3 * n, p + 4 * n, p + 5 * n, p + 6 * n, p + 7 * n, n}, z);
  return {phase(edges, poles.value), (edges.gz + poles.slope) / (4 * kPi)};
}

double Field::at(const Vec3& p, Vec3& gradient) {
  set_column(p.x, p.y);
  const EdgeSum edges = sums().edges(edge_arrays(), p.z, true);
  Vec3 sum(edges.gx, edges.gy, edges.gz);
  double value = 0;
  for (const Multipole& m : far_) {
    const Vec3 r = m.centre - p;
    const double inverse = 1 / glm::dot(r, r), cube = inverse * std::sqrt(inverse);
    const Vec3 q = m.quadrupole * r;
    const double dipole = glm::dot(m.dipole, r) + m.trace, quadrupole = glm::dot(r, q);
    value += (dipole - 3 * quadrupole * inverse) * cube;
    sum -= (m.dipole - 3 * inverse * (dipole * r + 2.0 * q) + 15 * quadrupole * inverse * inverse * r) * cube;
  }
  gradient = sum / (4 * kPi);
  return phase(edges, value);
}

double Field::curvature(double z, double half) const {
  double sum = far_curvature_;
  const Vec3 p(u_, v_, z);
  for (const auto& [a, b] : near_) sum += edge_curvature(glm::length(b - a), segment_distance(p, a, b) - half);
  return sum;
}

double Field::variation(double z, double half, double slope) const {
  double up[2] = {0, 0}, down[2] = {0, 0};  // of the near edges, above and below z
  for (const auto& [from, to] : near_) {
    for (const Vec3& end : {from, to})
      if (end.x == u_ && end.y == v_ && std::abs(end.z - z) <= half) return kInfinity;
    const Vec2 a = aside(from.x - u_, from.y - v_), b = aside(to.x - u_, to.y - v_);
    const double aa = glm::dot(a, a), bb = glm::dot(b, b), dot = glm::dot(a, b), cross = a.x * b.y - a.y * b.x;
    const auto share = [&](double height) {
      const double za = from.z - height, zb = to.z - height;
      const Stereographic s(za, aa), t(zb, bb);
      return std::atan2(s.f * t.f * cross, s.t * t.t + s.f * t.f * dot) / (2 * kPi);
    };
    const double za = from.z - z, zb = to.z - z, la = std::sqrt(aa + za * za), lb = std::sqrt(bb + zb * zb);
    const double below = la * lb * (la * lb + dot + za * zb);
    if (below > 0) slope -= cross * (la + lb) / below / (4 * kPi);
    const double middle = share(z);
    for (const int side : {0, 1}) {
      const double change = share(side == 0 ? z + half : z - half) - middle;
      // On a column through the edge K may turn either way: that is not for rounding to decide.
      if (change > 0 || cross == 0) up[side] += std::abs(change);
      if (change < 0 || cross == 0) down[side] += std::abs(change);
    }
  }
  return std::max({up[0], up[1], down[0], down[1]}) + std::abs(slope) * half + 0.5 * far_curvature_ * half * half;
}

}  // namespace riffler
