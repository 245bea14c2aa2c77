#include "dexel/field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace riffler {

namespace {

constexpr double kPi = 3.14159265358979323846;
/// Radii from the centre within which a piece's curvature is looked at place by place.
constexpr double kBeside = 1.7;
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

/// The phase of K, whose near edges' share is `edges`.
double phase(const EdgeSum& edges, double far) {
  return wrap(std::atan2(edges.im, edges.re) / (2 * kPi) - 0.5 + far);
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

void Field::add_point(const Vec3& p, bool joined, bool finite) {
  x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z), joined_.push_back(joined), finite_.push_back(finite);
}

void Field::fill(const BoundaryPieces& pieces, const Surroundings& around) {
  pieces_ = &pieces, around_ = &around, rays_ = 0;
  for (std::vector<double>* v : {&x_, &y_, &z_, &joined_, &finite_}) v->clear();
  for_each_chain(pieces, around.near, [&](const Chain& chain) {
    const Vec3& front = pieces.edges(pieces[around.near[chain.begin]]).front().a;
    const Vec3& back = pieces.edges(pieces[around.near[chain.end - 1]]).back().b;
    if (chain.open_front) add_point(glm::normalize(front - around.centre), false, false);
    add_point(front, chain.open_front);
    for (std::size_t k = chain.begin; k < chain.end; ++k)
      for (const BoundaryPieces::Edge& e : pieces.edges(pieces[around.near[k]])) add_point(e.b, true);
    if (chain.open_back) add_point(glm::normalize(back - around.centre), true, false);
    rays_ += (chain.open_front + chain.open_back) * edge_curvature(kInfinity, (Surroundings::kFar - 1) * around.radius);
  });
  // One point in front of the first group of lanes, and points that no edge leads to behind the last.
  while (z_.size() % kLanes != 1) add_point(Vec3(1, 0, 0), false, false);
  for (std::vector<double>* w : {&ax_, &ay_, &rr_, &dot_, &cross_}) w->resize(z_.size());
  scratch_.resize(4 * z_.size());
}

Field::Tangent Field::tangent(const Vec3& centre, const Vec3& half, double curved) {
  const double radius = glm::length(half);
  double curvature = rays_;
  for (const int k : around_->near) {
    const BoundaryPieces::Piece& piece = (*pieces_)[k];
    const double d = pieces_->distance(piece, centre, 2 * radius) - radius;
    if (!(d > 0)) return {0, kInfinity, Vec3(0)};
    curvature += BoundaryPieces::curvature(piece, d);
  }
  Tangent out;
  out.remainder = 0.5 * curvature * glm::dot(half, half) + curved;
  if (out.remainder > 1) return {0, kInfinity, Vec3(0)};
  out.phase = at(centre, out.gradient);
  return out;
}

void Field::enclose(const Vec3& half) {
  close_.clear();
  curvature_ = rays_ + around_->far.curvature_along(half);
  for (const int k : around_->near) {
    const BoundaryPieces::Piece& piece = (*pieces_)[k];
    const double d = pieces_->distance(piece, around_->centre, kBeside * around_->radius) - around_->radius;
    if (d > (kBeside - 1) * around_->radius)
      curvature_ += BoundaryPieces::curvature(piece, d);
    else
      close_.push_back(k);
  }
}

void Field::set_edges(double u, double v) {
  const std::size_t n = z_.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 a = aside(x_[k] - finite_[k] * u, y_[k] - finite_[k] * v);
    ax_[k] = a.x, ay_[k] = a.y, rr_[k] = a.x * a.x + a.y * a.y;
  }
  // Without an edge conj(α) β counts as 0, which leaves the product a positive factor.
  for (std::size_t k = 1; k < n; ++k) {
    dot_[k] = joined_[k] * (ax_[k - 1] * ax_[k] + ay_[k - 1] * ay_[k]);
    cross_[k] = joined_[k] * (ax_[k - 1] * ay_[k] - ay_[k - 1] * ax_[k]);
  }
}

void Field::set_column(double u, double v) {
  u_ = u, v_ = v;
  if (!around_->near.empty()) set_edges(u, v);
  far_ = around_->far.column(u - around_->centre.x, v - around_->centre.y);
}

Field::Value Field::at(double z) const {
  const double r = z - around_->centre.z;
  double far = 0, slope = 0;
  for (int k = LocalExpansion::kDegree; k >= 0; --k) slope = slope * r + far, far = far * r + far_[k];
  if (around_->near.empty()) return {wrap(far - 0.5), slope};
  const EdgeSum edges = sums().edges(edge_arrays(), z, false);
  return {phase(edges, far), edges.gz / (4 * kPi) + slope};
}

double Field::at(const Vec3& p, Vec3& gradient) {
  const double far = around_->far.at(p - around_->centre, gradient);
  if (around_->near.empty()) return wrap(far - 0.5);
  set_edges(p.x, p.y);
  const EdgeSum edges = sums().edges(edge_arrays(), p.z, true);
  gradient += Vec3(edges.gx, edges.gy, edges.gz) / (4 * kPi);
  return phase(edges, far);
}

double Field::curvature(double z, double half) const {
  double sum = curvature_;
  const Vec3 p(u_, v_, z);
  for (const int k : close_) {
    const BoundaryPieces::Piece& piece = (*pieces_)[k];
    sum += BoundaryPieces::curvature(piece, pieces_->distance(piece, p, 2 * half) - half);
  }
  return sum;
}

double Field::variation(double z, double half, double slope) const {
  double up[2] = {0, 0}, down[2] = {0, 0};  // of the close edges, above and below z
  for (const int k : close_)
    for (const BoundaryPieces::Edge& e : pieces_->edges((*pieces_)[k])) {
      const Vec3 &from = e.a, &to = e.b;
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
  return std::max({up[0], up[1], down[0], down[1]}) + std::abs(slope) * half + 0.5 * curvature_ * half * half;
}

}  // namespace riffler
