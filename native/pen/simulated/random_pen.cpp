#include "pen/simulated/random_pen.hpp"

#include <random>

namespace riffler::pen {

PenGeometry random_pen(const PenGeometry& described, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  // The distributions of the standard library differ between platforms.
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  PenGeometry out = described;
  for (PenChannel& c : out.channels) {
    c.torque_constant *= between(0.85, 1.15);
    c.coulomb *= between(0.6, 1.5);
    c.viscous *= between(0.6, 1.5);
    c.gravity *= between(0.7, 1.3);
    c.inertia *= between(0.85, 1.15);
  }
  out.grip_mass *= between(0.85, 1.15);
  out.grip_inertia *= between(0.85, 1.15);
  return out;
}

}  // namespace riffler::pen
