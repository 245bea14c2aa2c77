// The sums over a boundary that Field evaluates, written so that compilers turn them into vector code.
#pragma once

#include <cstddef>

namespace riffler {

inline constexpr std::size_t kLanes = 8;

/// Polylines about one column: arrays of n + 1 points, n a multiple of kLanes. An edge leads to each point but the
/// first from the one before it, unless `joined` is 0 there. See Field for what they are.
struct EdgeArrays {
  const double *x, *y, *z, *rr, *dot, *cross, *joined;
  double* scratch;  // 4 (n + 1)
  std::size_t n;
};

struct EdgeSum {
  double re, im;      // product over the edges, scaled
  double gx, gy, gz;  // Σ (a × b) (|a| + |b|) / (|a| |b| (|a| |b| + a·b))
};

/// The product, gz, and (with `full`) gx and gy at the height z. The same bits on every processor.
EdgeSum sum_edges(const EdgeArrays& in, double z, bool full);

/// Dipoles and quadrupoles about one column: arrays of n, a multiple of kLanes. With r = (x, y, z − height), the dipole
/// D and the symmetric quadrupole Q with its trace: D·r = across + dz rz, r·Qr = flat + 2 skew rz + qzz rz².
struct PoleArrays {
  const double *z, *rr, *dz, *across, *flat, *skew, *qzz, *trace;
  std::size_t n;
};

struct PoleSum {
  double value, slope;  // Σ D·r / r³ + trace / r³ − 3 r·Qr / r⁵, and its derivative by the height
};

PoleSum sum_poles(const PoleArrays& in, double z);

}  // namespace riffler
