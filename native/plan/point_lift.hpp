// How far a tool has to go along its own axis until a fixed point is out of it.
#pragma once

#include <vector>

#include "riffler/tool/outline.hpp"

namespace riffler::plan {

/// The tool grown by c (shrunk where c < 0): all points whose signed distance from it is below c. In a column at radius
/// ρ round the axis it covers some intervals of heights, whose ends are in closed form: an offset edge, a circle round
/// a corner or an arc's centre. Nothing is sampled.
class OffsetToolColumns {
 public:
  /// Keeps a pointer to the outline.
  explicit OffsetToolColumns(const tool::Outline& outline, double c) : outline_(&outline), c_(c) {}

  struct Column {
    bool covered = false;
    double low = 0, high = 0;  ///< the interval of heights round z that the grown tool covers
  };
  /// The interval that holds (ρ, z), which a lift by z − low gets out of, as a lowering by high − z.
  Column at(double rho, double z) const;

 private:
  bool covers(double rho, double z) const { return outline_->nearest(rho, z).distance < c_; }
  void candidates(double rho, std::vector<double>& heights) const;

  const tool::Outline* outline_;
  double c_;
};

}  // namespace riffler::plan
