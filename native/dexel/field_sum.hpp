// The sums over what is far of a boundary, written so that compilers turn them into vector code.
#pragma once

#include <cstddef>
#include <vector>

namespace riffler {

inline constexpr std::size_t kSourceLanes = 8;

/// What is far from the origin, n a multiple of kSourceLanes:
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
  SourceSum sources(const SourceArrays& in) const;

  /// All that this processor can run, the fastest first. They give the same bits.
  static const std::vector<FieldSums>& available();

 private:
  struct SourceLanes {
    double terms[2][kExpansionDegree + 1][kExpansionDegree + 1][kSourceLanes];
  };
  friend struct FieldLanes;

  void (*sources_)(const SourceArrays&, SourceLanes&);
};

}  // namespace riffler
