// The stiffest virtual wall that a device renders without giving energy to the hand, for any motion of the hand.
#pragma once

namespace riffler::haptics {

/// A device in one coordinate, or its effective values along a contact's direction. Zero friction, damping or
/// resolution is allowed. Units: mm, s, N, or rad, s, N·mm.
struct DeviceTraits {
  double period;      ///< s, of the sample and hold
  double damping;     ///< N·s/mm
  double friction;    ///< N, Coulomb
  double resolution;  ///< mm, step of the measured position
};

/// N/mm; 0 if the device is not passive at any stiffness. `sampling`: b > K T/2 + |B| for a wall K x + B ẋ with ẋ
/// from the last two samples (Colgate and Schenkel 1997, (2.13) in methods). `quantisation`: K ≤ 2 f_c/Δ (Abbott and
/// Okamura 2005), infinite for a step of zero. The wall is passive if it is no stiffer than either.
struct PassiveStiffness {
  double sampling, quantisation;

  double least() const { return sampling < quantisation ? sampling : quantisation; }
};

/// `wall_damping`: B, N·s/mm. Throws std::invalid_argument naming the field.
PassiveStiffness passive_stiffness(const DeviceTraits& device, double wall_damping = 0);

}  // namespace riffler::haptics
