// Reads from the rays whether each lattice point is inside or outside.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "marching/bricks.hpp"
#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::marching {

/// The lattice points in a span: first … last, empty if first > last.
struct PointRange {
  int first, last;
};

/// Converts spans of the rays along one lattice axis to lattice points: those with near + εh < point < far − εh, ε =
/// 10⁻³. The margin makes all rays classify a plane on a lattice plane the same, regardless of the last bits of their
/// ends.
class PointsOfSpan {
 public:
  PointsOfSpan(const Lattice& lattice, int axis)
      : zero_(lattice.at(axis, 0)), per_pitch_(1 / lattice.pitch()), last_(lattice.rays(axis)) {}

  PointRange operator()(const dexel::Span& s) const {
    const double near = (s.near - zero_) * per_pitch_, far = (s.far - zero_) * per_pitch_;
    return {above(near + kMargin), below(far - kMargin)};
  }
  /// Keeps a floor thinner than the pitch closed: a span without a lattice point takes the nearest one.
  PointRange or_nearest(const dexel::Span& s) const {
    const PointRange range = (*this)(s);
    if (range.first <= range.last) return range;
    const int nearest = above(((s.near - zero_) + (s.far - zero_)) * per_pitch_ / 2 - 0.5);
    const int kept = std::min(nearest, last_);
    return {kept, kept};
  }

 private:
  static constexpr double kMargin = 1e-3;
  /// The lowest point > x and the highest point < x, within the lattice; spans may extend beyond the box.
  int above(double x) const { return static_cast<int>(std::clamp(x, 0.0, last_ + 1.0)) + 1; }
  int below(double x) const {
    const double clamped = std::clamp(x, 0.0, last_ + 1.0);
    const int whole = static_cast<int>(clamped);
    return whole - static_cast<int>(whole == clamped);
  }

  double zero_, per_pitch_;
  int last_;
};

/// The three rays through a point of a tri-dexel volume decide by majority.
class SignReader {
 public:
  explicit SignReader(const Lattice& lattice);
  /// Sets the volume to read from; it must outlive the reading.
  void follow(const Volume& volume);

  /// Reads the signs of the bricks (a, b, c0 … c1).
  void read(Bricks& bricks, int a, int b, int c0, int c1) const;

 private:
  /// Properties shared by all rays of a tile.
  struct TileExtent {
    int hull_first, hull_last;  // no ray contains a point outside this range
    int core_first, core_last;  // every ray contains all points of this range
    std::uint64_t revision = ~std::uint64_t{0};
  };
  using Rows = std::vector<SignRows>;

  void read_reference(int a, int b, int c0, int c1, Rows& rows) const;
  bool agree(const Vec3i& brick, bool inside) const;
  void read_y(const Vec3i& brick, SignRows& rows) const;
  void vote(const Vec3i& brick, const SignRows& y, SignRows& z) const;
  bool along_x(int i, int j, int k) const;

  const Lattice& lattice_;
  const dexel::Grid *reference_ = nullptr, *x_ = nullptr, *y_ = nullptr;
  PointsOfSpan points_x_, points_y_, points_z_;
  std::vector<TileExtent> extents_;  // of the tiles of y
};

/// Reads the signs of all bricks.
void read_signs(const SignReader& reader, Bricks& bricks, const Progress& progress);

}  // namespace riffler::marching
