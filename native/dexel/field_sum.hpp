// The sums over a boundary that Field evaluates, written so that compilers turn them into vector code.
#pragma once

#include <cstddef>
#include <vector>

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

/// Dipoles and quadrupoles about one column: arrays of n, a multiple of kLanes. With r = (x, y, z − height), the dipole
/// D and the symmetric quadrupole Q with its trace: D·r = across + dz rz, r·Qr = flat + 2 skew rz + qzz rz².
struct PoleArrays {
  const double *z, *rr, *dz, *across, *flat, *skew, *qzz, *trace;
  std::size_t n;
};

struct PoleSum {
  double value, slope;  // Σ D·r / r³ + trace / r³ − 3 r·Qr / r⁵, and its derivative by the height
};

/// Both sums for one set of instructions.
class FieldSums {
 public:
  /// The product, gz, and (with `full`) gx and gy at the height z.
  EdgeSum edges(const EdgeArrays& in, double z, bool full) const;
  PoleSum poles(const PoleArrays& in, double z) const;

  /// All that this processor can run, the fastest first. They give the same bits.
  static const std::vector<FieldSums>& available();

 private:
  struct EdgeLanes {
    double re[kLanes], im[kLanes], gx[kLanes], gy[kLanes], gz[kLanes];
  };
  struct PoleLanes {
    double value[kLanes], slope[kLanes];
  };
  friend struct FieldLanes;

  void (*edges_)(const EdgeArrays&, double, bool, EdgeLanes&);
  void (*poles_)(const PoleArrays&, double, PoleLanes&);
};

}  // namespace riffler
