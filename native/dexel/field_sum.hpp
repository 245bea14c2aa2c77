// The sums over a boundary that Field evaluates, written so that compilers turn them into vector code.
#pragma once

#include <cstddef>
#include <vector>

namespace riffler {

inline constexpr std::size_t kLanes = 8;

/// Polylines about one column: arrays of n + 1 points, n a multiple of kLanes. An edge leads to each point but the
/// first from the one before it, unless `joined` is 0 there. `finite` is 0 where a point lies at infinity, in the
/// direction (x, y, z) of length 1. See Field for what they are.
struct EdgeArrays {
  const double *x, *y, *z, *rr, *dot, *cross, *joined, *finite;
  double* scratch;  // 4 (n + 1)
  std::size_t n;
};

struct EdgeSum {
  double re, im;      // product over the edges, scaled
  double gx, gy, gz;  // Σ (a × b) (|a| + |b|) / (|a| |b| (|a| |b| + a·b))
};

/// What is far from the origin, n a multiple of kLanes:
/// - edges from a to a + e, w = a × e;
/// - where `endless` is 1, edges from a to infinity in the direction of a + e, w = a × e;
/// - where `dipole` is 1, small surfaces at a, −w their area vector, e = 0.
struct SourceArrays {
  const double *ax, *ay, *az, *ex, *ey, *ez, *wx, *wy, *wz, *endless, *dipole;
  std::size_t n;
};

inline constexpr int kExpansionDegree = 5;

/// The terms of K's Taylor polynomial about the origin with the powers x^i y^j z^k, k < 2, 1 ≤ i + j + k ≤ degree.
struct SourceSum {
  double terms[2][kExpansionDegree + 1][kExpansionDegree + 1];
};

/// The sums for one set of instructions.
class FieldSums {
 public:
  /// The product, gz, and (with `full`) gx and gy at the height z.
  EdgeSum edges(const EdgeArrays& in, double z, bool full) const;
  SourceSum sources(const SourceArrays& in) const;

  /// All that this processor can run, the fastest first. They give the same bits.
  static const std::vector<FieldSums>& available();

 private:
  struct EdgeLanes {
    double re[kLanes], im[kLanes], gx[kLanes], gy[kLanes], gz[kLanes];
  };
  struct SourceLanes {
    double terms[2][kExpansionDegree + 1][kExpansionDegree + 1][kLanes];
  };
  friend struct FieldLanes;

  void (*edges_)(const EdgeArrays&, double, bool, EdgeLanes&);
  void (*sources_)(const SourceArrays&, SourceLanes&);
};

}  // namespace riffler
