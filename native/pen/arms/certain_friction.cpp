#include "pen/arms/certain_friction.hpp"

#include <algorithm>

namespace riffler::pen {

namespace {

constexpr double kInterval = 1.96;  // standard uncertainties to each end of a 95 % interval

}  // namespace

CertainFriction certain_friction(const PenGeometry& pen, std::size_t channel) noexcept {
  if (!pen.uncertainty) return {};
  const PenChannel& c = pen.channels[channel];
  return {std::max(0.0, c.coulomb - kInterval * pen.uncertainty->coulomb[channel]),
          std::max(0.0, c.viscous - kInterval * pen.uncertainty->viscous[channel])};
}

double certain_share(const PenGeometry& pen, std::size_t channel) noexcept {
  const PenChannel& c = pen.channels[channel];
  const CertainFriction certain = certain_friction(pen, channel);
  double share = 1;
  if (c.coulomb > 0) share = std::min(share, certain.coulomb / c.coulomb);
  if (c.viscous > 0) share = std::min(share, certain.viscous / c.viscous);
  return share;
}

}  // namespace riffler::pen
