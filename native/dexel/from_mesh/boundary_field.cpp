#include "dexel/from_mesh/boundary_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/functions.hpp"
#include "geom/math.hpp"

namespace riffler::dexel {

namespace {

/// Length of an edge, relative to its distance, up to which two Gauss points are enough.
constexpr double kShort = 1.0 / 4;
/// Radius of a piece, relative to its distance, up to which its bounding ball locates it well enough.
constexpr double kSmall = 0.25;
/// A loop of up to this many edges is one piece.
constexpr int kWhole = 8;
/// Maximum error of K from replacing a surface by a dipole.
constexpr double kLeftOut = 2e-6;

}  // namespace

double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a, r = p - a;
  const double dd = glm::dot(d, d);
  const double t = dd > 0 ? std::clamp(glm::dot(r, d) / dd, 0.0, 1.0) : 0;
  return glm::length(r - t * d);
}

BoundaryPieces::BoundaryPieces(const std::vector<std::vector<Vec3>>& loops) {
  for (const std::vector<Vec3>& loop : loops) {
    const int first = static_cast<int>(edges_.size()), start = size(), n = static_cast<int>(loop.size());
    if (n < 2) continue;  // a single point has only an edge to itself
    for (int k = 0; k < n; ++k) {
      edges_.push_back({loop[k], loop[(k + 1) % n]});
      length_ += glm::length(edges_.back().b - edges_.back().a);
    }
    if (n <= kWhole) {
      pieces_.push_back({first, first + n, -1, -1, 0, span(first, first + n)});
      for (int k = 0; k < n; ++k) pieces_.back().length += glm::length(edges_[first + k].b - edges_[first + k].a);
      continue;
    }
    for (int k = 0; k < n; ++k) {
      const Edge& e = edges_[first + k];
      const double edge = glm::length(e.b - e.a);
      pieces_.push_back({first + k,
                         first + k + 1,
                         start + (k + n - 1) % n,
                         start + (k + 1) % n,
                         edge,
                         {0.5 * (e.a + e.b), 0.5 * edge, 0, 0, Vec3(0), {}}});
    }
    add_chains(start, size());
  }
  for (const Piece& piece : pieces_) add_ends(piece);
}

void BoundaryPieces::add_ends(const Piece& piece) {
  for (const Edge& e : edges(piece)) {
    const Vec3 d = e.b - e.a;
    const double square = glm::dot(d, d);
    ends_.push_back({e.b.x, e.b.y, e.b.z, true, true, false, square > 0 ? 1 / square : 0, 0.5 * std::sqrt(square), 0});
  }
  ends_.back().ends = true;
  ends_.back().area = piece.is_loop() ? 1.5 * piece.surface.area : std::numeric_limits<double>::infinity();
}

/// The surface between the edges and the chord that closes them.
BoundaryPieces::Surface BoundaryPieces::span(int first, int last) const {
  Surface out{Vec3(0), 0, 0, 0, Vec3(0), {}};
  Box3 box;
  for (int k = first; k < last; ++k) box.add(edges_[k].a), box.add(edges_[k].b);
  out.centre = 0.5 * (box.lower + box.upper), out.box = box;
  Mat3 moment(0);
  const auto add = [&](const Vec3& from, const Vec3& to) {
    const Vec3 a = from - out.centre, b = to - out.centre, vector = 0.5 * glm::cross(a, b);
    out.radius = std::max(out.radius, glm::length(a));
    out.area += glm::length(vector), out.vector += vector;
    moment += glm::outerProduct(vector, (a + b) / 3.0);
  };
  for (int k = first; k < last; ++k) add(edges_[k].a, edges_[k].b);
  add(edges_[last - 1].b, edges_[first].a);
  // The centre for which the vector's direction varies least.
  const double square = glm::dot(out.vector, out.vector);
  if (square > 1e-6 * out.area * out.area) {
    const Vec3 shift = glm::transpose(moment) * out.vector / square;
    if (glm::length(shift) < out.radius) {
      out.centre += shift, out.radius += glm::length(shift);
      moment -= glm::outerProduct(out.vector, shift);
    }
  }
  double norm = 0;
  for (int k = 0; k < 3; ++k) norm += glm::dot(moment[k], moment[k]);
  // The error has a quadrupole and second moments, which fall with the third and fourth power of the distance.
  out.far_enough = std::max({2 * out.radius, base::pow(3 * std::sqrt(norm) / (4 * kPi * kLeftOut), 1.0 / 3),
                             std::sqrt(std::sqrt(3 * out.area * out.radius * out.radius / (4 * kPi * kLeftOut)))});
  return out;
}

void BoundaryPieces::add_chains(int first, int last) {
  surfaces_.resize(pieces_.size());
  for (int level = 1; 1 << level <= last - first; ++level)
    for (int k = first; k + (1 << level) <= last; k += 1 << level)
      surfaces_[k].push_back(span(pieces_[k].first, pieces_[k + (1 << level) - 1].last));
}

const BoundaryPieces::Surface* BoundaryPieces::surface(int k, int level) const {
  const auto& levels = surfaces_[k];
  return level <= static_cast<int>(levels.size()) ? &levels[level - 1] : nullptr;
}

double BoundaryPieces::distance(const Piece& piece, const Vec3& p, double near) const {
  const double d = glm::length(piece.surface.centre - p) - piece.surface.radius;
  if (d >= near || piece.surface.radius < kSmall * near) return d;
  double least = std::numeric_limits<double>::infinity();
  for (const Edge& e : edges(piece)) least = std::min(least, segment_distance(p, e.a, e.b));
  return least;
}

Surroundings Descent::root(const Vec3& centre, double radius) const {
  Surroundings all;
  all.centre = centre, all.radius = radius;
  all.near.resize(static_cast<std::size_t>(pieces_.size()));
  std::iota(all.near.begin(), all.near.end(), 0);
  return all;
}

void Descent::enter(const Surroundings& parent, const Vec3& centre, double radius, Surroundings& out) {
  edges_.count = dipoles_.count = 0, centre_ = centre, far_ = &out.far;
  re_ = 1, im_ = 0, surfaces_ = 0;
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
  int begin = 0, end = 0;  // current chain of far edges
  for (const int k : parent.near) {
    const BoundaryPieces::Piece& piece = pieces_[k];
    if (pieces_.distance(piece, centre, reach) < reach) {
      out.near.push_back(k);
    } else if (piece.is_loop()) {
      add_loop(piece);
    } else {
      if (k != end || (k > 0 && pieces_[k].previous != k - 1)) add_chain(begin, end), begin = k;
      end = k + 1;
    }
  }
  add_chain(begin, end);
  flush(edges_), flush(dipoles_);
  const double k = out.far.constant() + surfaces_ + base::atan2(im_, re_) / (2 * kPi);
  out.far.set_constant(k - std::round(k));
}

void Descent::add_loop(const BoundaryPieces::Piece& loop) {
  const BoundaryPieces::Surface& s = loop.surface;
  const double d = glm::length(s.centre - centre_) - s.radius;
  if (d >= s.far_enough) return add_dipole(s);
  for (const BoundaryPieces::Edge& e : pieces_.edges(loop)) add_edge(e.a, e.b, d);
}

/// Adds the chain as few chords, and the surfaces between them and the chain.
void Descent::add_chain(int first, int last) {
  for (int k = first, level = 0; k < last; k += 1 << level) {
    for (++level;; --level) {
      if (level == 0) {
        const BoundaryPieces::Edge& e = pieces_.edges(pieces_[k]).front();
        add_edge(e.a, e.b, pieces_.distance(pieces_[k], centre_, 0));
        break;
      }
      const BoundaryPieces::Surface* s = k + (1 << level) <= last ? pieces_.surface(k, level) : nullptr;
      if (!s) continue;
      const double d = glm::length(s->centre - centre_) - s->radius;
      const Vec3 &a = pieces_.edges(pieces_[k]).front().a, &b = pieces_.edges(pieces_[k + (1 << level) - 1]).front().b;
      if (d < s->far_enough || glm::length(b - a) > kShort * d) continue;
      add_edge(a, b, d);
      if (s->area > 0) add_dipole(*s);
      break;
    }
  }
}

void Descent::add_dipole(const BoundaryPieces::Surface& surface) {
  push(dipoles_, surface.centre - centre_, Vec3(0), -surface.vector, 0);
}

/// Adds an edge that is at least `distance` away.
void Descent::add_edge(const Vec3& a, const Vec3& b, double distance) {
  add_source(a - centre_, b - centre_, distance);
}

void Descent::add_source(const Vec3& a, const Vec3& b, double distance) {
  if (glm::length(b - a) > kShort * distance) {
    distance = segment_distance(Vec3(0), a, b);
    if (glm::length(b - a) > kShort * distance) {
      const Vec3 middle = 0.5 * (a + b);
      add_source(a, middle, distance), add_source(middle, b, distance);
      return;
    }
  }
  push(edges_, a, b - a, glm::cross(a, b), 0);
}

/// Adds a half-line from a to infinity, directed away from `from`.
void Descent::add_wedge(const Vec3& a, const Vec3& from, double sign) {
  push(edges_, a, -from, sign * glm::cross(a, -from), 1);
}

void Descent::push(Batch& batch, const Vec3& a, const Vec3& e, const Vec3& w, double endless) {
  if (batch.count == Batch::kMax) flush(batch);
  const double values[] = {a.x, a.y, a.z, e.x, e.y, e.z, w.x, w.y, w.z, endless};
  for (int k = 0; k < 10; ++k) batch.arrays[k][batch.count] = values[k];
  ++batch.count;
}

void Descent::flush(Batch& batch) {
  if (batch.count == 0) return;
  while (batch.count % kSourceLanes != 0) push(batch, Vec3(1, 0, 0), Vec3(0), Vec3(0), 0);
  const auto& in = batch.arrays;
  const SourceSum sum =
      sum_sources({in[0], in[1], in[2], in[3], in[4], in[5], in[6], in[7], in[8], in[9], batch.count, batch.dipoles});
  batch.count = 0;
  far_->add(sum);
  surfaces_ += sum.dipoles;
  const double re = re_ * sum.re - im_ * sum.im, im = re_ * sum.im + im_ * sum.re;
  const double scale = 1 / (std::abs(re) + std::abs(im) + 1e-300);
  re_ = re * scale, im_ = im * scale;
}

}  // namespace riffler::dexel
