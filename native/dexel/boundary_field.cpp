#include "dexel/boundary_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dexel/field.hpp"

namespace riffler {

namespace {

constexpr double kPi = 3.14159265358979323846;
/// Length of an edge in its distances up to which two points of Gauss are enough.
constexpr double kShort = 1.0 / 6;
/// Loops of so many edges are pieces as a whole.
constexpr int kWhole = 8;
/// What a dipole may leave out of K.
constexpr double kLeftOut = 2e-6;

}  // namespace

BoundaryPieces::BoundaryPieces(const std::vector<std::vector<Vec3>>& loops) {
  for (const std::vector<Vec3>& loop : loops) {
    const int first = static_cast<int>(edges_.size()), start = size(), n = static_cast<int>(loop.size());
    if (n < 2) continue;  // one point: an edge from it to itself
    for (int k = 0; k < n; ++k) {
      edges_.push_back({loop[k], loop[(k + 1) % n]});
      length_ += glm::length(edges_.back().b - edges_.back().a);
    }
    if (n <= kWhole) {
      add_loop(first, first + n);
      continue;
    }
    for (int k = 0; k < n; ++k) {
      const Edge& e = edges_[first + k];
      const double length = glm::length(e.b - e.a);
      pieces_.push_back({first + k, first + k + 1, start + (k + n - 1) % n, start + (k + 1) % n, 0.5 * (e.a + e.b),
                         0.5 * length, length});
    }
  }
}

void BoundaryPieces::add_loop(int first, int last) {
  Piece piece{first, last, -1, -1, Vec3(0), 0, 0};
  Box3 box;
  for (int k = first; k < last; ++k) box.add(edges_[k].a);
  piece.centre = 0.5 * (box.lower + box.upper);
  Mat3 moment(0);
  for (int k = first; k < last; ++k) {
    const Vec3 a = edges_[k].a - piece.centre, b = edges_[k].b - piece.centre, vector = 0.5 * glm::cross(a, b);
    piece.radius = std::max(piece.radius, glm::length(a));
    piece.length += glm::length(b - a), piece.area += glm::length(vector), piece.dipole += vector;
    moment += glm::outerProduct(vector, (a + b) / 3.0);
  }
  // The centre from which the area's vector is seen to turn least.
  const double square = glm::dot(piece.dipole, piece.dipole);
  if (square > 1e-6 * piece.area * piece.area) {
    const Vec3 shift = glm::transpose(moment) * piece.dipole / square;
    piece.centre += shift, piece.radius += glm::length(shift);
    moment -= glm::outerProduct(piece.dipole, shift);
  }
  double norm = 0;
  for (int k = 0; k < 3; ++k) norm += glm::dot(moment[k], moment[k]);
  // What is left out: quadrupole and the second moments, by the third and fourth power of the distance.
  piece.far_enough = std::max({2 * piece.radius, std::cbrt(3 * std::sqrt(norm) / (4 * kPi * kLeftOut)),
                               std::sqrt(std::sqrt(3 * piece.area * piece.radius * piece.radius / (4 * kPi * kLeftOut)))});
  pieces_.push_back(piece);
}

double BoundaryPieces::distance(const Piece& piece, const Vec3& p, double near) const {
  const double d = glm::length(piece.centre - p) - piece.radius;
  if (d >= near) return d;
  double least = std::numeric_limits<double>::infinity();
  for (const Edge& e : edges(piece)) least = std::min(least, segment_distance(p, e.a, e.b));
  return least;
}

/// Third derivatives of 1/r are at most 6 / r⁴.
double BoundaryPieces::curvature(const Piece& piece, double d) {
  const double edges = edge_curvature(piece.length, d);
  if (!piece.is_loop() || !(d > 0)) return edges;
  return std::min(edges, 6 * piece.area / (4 * kPi * d * d * d * d));
}

Surroundings Descent::root(const Vec3& centre, double radius) const {
  Surroundings all;
  all.centre = centre, all.radius = radius;
  all.near.resize(static_cast<std::size_t>(pieces_.size()));
  std::iota(all.near.begin(), all.near.end(), 0);
  return all;
}

void Descent::enter(const Surroundings& parent, const Vec3& centre, double radius, Surroundings& out) {
  for (std::vector<double>& array : arrays_) array.clear();
  re_ = 1, im_ = 0, dipoles_ = 0;
  out.centre = centre, out.radius = radius;
  out.far = parent.far;
  out.far.shift(centre - parent.centre);

  for_each_chain(pieces_, parent.near, [&](const Chain& chain) {
    const auto front = pieces_.edges(pieces_[parent.near[chain.begin]]);
    const auto back = pieces_.edges(pieces_[parent.near[chain.end - 1]]);
    if (chain.open_front) add_wedge(front.front().a - centre, parent.centre - centre, -1);
    if (chain.open_back) add_wedge(back.back().b - centre, parent.centre - centre, 1);
  });
  out.near.clear();
  const double reach = Surroundings::kFar * radius;
  for (const int k : parent.near) {
    const BoundaryPieces::Piece& piece = pieces_[k];
    if (const double d = pieces_.distance(piece, centre, reach); d < reach) {
      out.near.push_back(k);
    } else if (piece.is_loop() && d >= piece.far_enough) {
      add_dipole(piece.centre - centre, piece.dipole);
    } else {
      for (const BoundaryPieces::Edge& e : pieces_.edges(piece)) {
        turn(e.a - centre, e.b - centre, 1);
        add_source(e.a - centre, e.b - centre, 1);
      }
    }
  }
  while (arrays_[0].size() % kLanes != 0) push(Vec3(1, 0, 0), Vec3(0), Vec3(0), 0, 0);
  if (!arrays_[0].empty())
    out.far.add({arrays_[0].data(), arrays_[1].data(), arrays_[2].data(), arrays_[3].data(), arrays_[4].data(),
                 arrays_[5].data(), arrays_[6].data(), arrays_[7].data(), arrays_[8].data(), arrays_[9].data(),
                 arrays_[10].data(), arrays_[0].size()});
  const double k = out.far.constant() + dipoles_ + std::atan2(im_, re_) / (2 * kPi);
  out.far.set_constant(k - std::round(k));
}

void Descent::add_dipole(const Vec3& centre, const Vec3& dipole) {
  const double d = glm::length(centre);
  dipoles_ += glm::dot(dipole, centre) / (4 * kPi * d * d * d);
  push(centre, Vec3(0), -dipole, 0, 1);
}

void Descent::add_source(const Vec3& a, const Vec3& b, double sign) {
  const double length = glm::length(b - a);
  if (length > kShort * segment_distance(Vec3(0), a, b)) {
    const Vec3 middle = 0.5 * (a + b);
    add_source(a, middle, sign), add_source(middle, b, sign);
    return;
  }
  push(a, b - a, sign * glm::cross(a, b), 0, 0);
}

/// From a to infinity, away from `from`.
void Descent::add_wedge(const Vec3& a, const Vec3& from, double sign) {
  push(a, -from, sign * glm::cross(a, -from), 1, 0);
  const Vec3 along = glm::normalize(a - from);
  const double length = glm::length(a);
  // A direction enters as a point does, with its length 1 for the distance.
  turn(a / length, along, sign);
}

void Descent::push(const Vec3& a, const Vec3& e, const Vec3& w, double endless, double dipole) {
  const double values[] = {a.x, a.y, a.z, e.x, e.y, e.z, w.x, w.y, w.z, endless, dipole};
  for (int k = 0; k < 11; ++k) arrays_[k].push_back(values[k]);
}

/// The factor of an edge at the centre, whose argument is half the solid angle.
void Descent::turn(const Vec3& a, const Vec3& b, double sign) {
  const double aa = a.x * a.x + a.y * a.y, bb = b.x * b.x + b.y * b.y;
  const Stereographic s(a.z, aa), t(b.z, bb);
  const double f = s.f * t.f, x = s.t * t.t + f * (a.x * b.x + a.y * b.y), y = sign * f * (a.x * b.y - a.y * b.x);
  const double re = re_ * x - im_ * y, im = re_ * y + im_ * x, scale = 1 / (std::abs(re) + std::abs(im) + 1e-300);
  re_ = re * scale, im_ = im * scale;
}

}  // namespace riffler
