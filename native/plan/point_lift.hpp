// How far a tool must move along its own axis until a fixed point is outside it.
#pragma once

#include <vector>

#include "riffler/tool/outline.hpp"

namespace riffler::plan {

/// The tool enlarged by c (shrunk for c < 0): all points with a signed distance below c. In a column at radius ρ from
/// the axis it covers some intervals of height, with ends in closed form: an offset edge, or a circle around a corner
/// or an arc's centre. No sampling.
class OffsetToolColumns {
 public:
  /// Keeps a pointer to the outline. `c`: mm.
  explicit OffsetToolColumns(const tool::Outline& outline, double c) : outline_(&outline), c_(c) {}

  struct Column {
    bool covered = false;
    double low = 0, high = 0;  ///< interval of heights around z covered by the enlarged tool, mm
  };
  /// The interval that contains (ρ, z): a lift by z − low leaves it, or a lowering by high − z.
  Column at(double rho, double z) const;

 private:
  bool covers(double rho, double z) const { return outline_->nearest(rho, z).distance < c_; }
  void candidates(double rho, std::vector<double>& heights) const;

  const tool::Outline* outline_;
  double c_;
};

}  // namespace riffler::plan
