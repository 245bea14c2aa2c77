// The sum over a boundary's edges that Field evaluates, written so that compilers turn it into vector code.
#pragma once

#include <cstddef>

namespace riffler {

/// Polylines about one column: arrays of n points, n a multiple of kLanes, at least kLanes, each array with one more
/// element in front that belongs to no edge. See Field for what they are.
struct FieldInput {
  static constexpr std::size_t kLanes = 8;
  const double *x, *y, *z, *rr, *dot, *cross, *joined;
  double* scratch;  // 4 (n + 1)
  std::size_t n;
};

struct FieldSum {
  double re, im;      // product over the edges, scaled
  double gx, gy, gz;  // Σ (a × b) (|a| + |b|) / (|a| |b| (|a| |b| + a·b))
};

/// The product, gz, and (with `full`) gx and gy at the height z. The same bits on every processor.
FieldSum sum_field(const FieldInput& in, double z, bool full);

}  // namespace riffler
