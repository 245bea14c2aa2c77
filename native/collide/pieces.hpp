// A triangle cut into convex pieces that are not long.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "collide/triangle_search.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::collide {

/// A small convex polygon in space.
class Piece {
 public:
  explicit Piece(const Corners& t) : points_{t.a, t.b, t.c}, size_(3) {}

  std::span<const Vec3> points() const { return {points_.data(), size_}; }

  /// Area vector, mm²: its length is the area.
  Vec3 area() const {
    Vec3 sum(0);
    for (std::size_t i = 1; i + 1 < size_; ++i)
      sum += 0.5 * glm::cross(points_[i] - points_[0], points_[i + 1] - points_[0]);
    return sum;
  }

  Vec3 centroid() const {
    Vec3 sum(0), middle(0);
    double size = 0;
    for (std::size_t i = 0; i < size_; ++i) middle += (points_[i] - points_[0]) / static_cast<double>(size_);
    for (std::size_t i = 1; i + 1 < size_; ++i) {
      const Vec3 b = points_[i] - points_[0], c = points_[i + 1] - points_[0];
      const double s = glm::length(glm::cross(b, c));
      sum += s / 3 * (b + c), size += s;
    }
    return points_[0] + (size > 0 ? sum / size : middle);
  }

  /// The two corners farthest apart.
  std::array<std::size_t, 2> ends() const {
    std::array<std::size_t, 2> out{0, 1};
    double most = -1;
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t j = i + 1; j < size_; ++j) {
        const Vec3 d = points_[j] - points_[i];
        if (const double square = glm::dot(d, d); square > most) most = square, out = {i, j};
      }
    return out;
  }

  /// Halves it across the line between two of its corners, through the middle. A corner exactly there belongs to both.
  std::array<Piece, 2> halves(const std::array<std::size_t, 2>& ends) const {
    const Vec3 way = points_[ends[1]] - points_[ends[0]], middle = 0.5 * (points_[ends[0]] + points_[ends[1]]);
    std::array<Piece, 2> out{Piece(), Piece()};
    for (std::size_t i = 0; i < size_; ++i) {
      const Vec3 &p = points_[i], &q = points_[(i + 1) % size_];
      const double here = glm::dot(p - middle, way), there = glm::dot(q - middle, way);
      if (here <= 0) out[0].add(p);
      if (here >= 0) out[1].add(p);
      if ((here < 0 && there > 0) || (here > 0 && there < 0)) {
        const Vec3 at = p + here / (here - there) * (q - p);
        out[0].add(at), out[1].add(at);
      }
    }
    return out;
  }

 private:
  // A cut adds at most one corner to either half, and the kDeepest-th of a finite triangle is done.
  static constexpr std::size_t kMaxCorners = 64;

  Piece() = default;
  void add(const Vec3& p) {
    if (size_ < kMaxCorners) points_[size_++] = p;
  }

  std::array<Vec3, kMaxCorners> points_;
  std::size_t size_ = 0;
};

/// Visits the pieces of a triangle: halved across their longest diagonal until none is longer than `most` (mm). Pieces
/// with less area than `least` (mm²) may be as long as `longest`.
template <class Visit>
void cut_into_pieces(const Piece& piece, double most, double least, double longest, const Visit& visit) {
  const std::array<std::size_t, 2> ends = piece.ends();
  const double length = glm::length(piece.points()[ends[1]] - piece.points()[ends[0]]);
  if (!(length > most) || (!(length > longest) && glm::length(piece.area()) < least)) return visit(piece);
  for (const Piece& half : piece.halves(ends)) cut_into_pieces(half, most, least, longest, visit);
}

}  // namespace riffler::collide
