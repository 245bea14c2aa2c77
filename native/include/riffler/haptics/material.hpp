// Properties of a stock's or fixture's material that a hand can feel.
#pragma once

#include <string>

namespace riffler::haptics {

struct Material {
  double stiffness = 1;            ///< of a surface, N per mm of depth and mm²; of a fixture, N per mm³ inside the tool
  double removal_constant = 0.05;  ///< N·s/mm³: force per volume removed per second
  double damping = 0;              ///< N·s/mm: additional friction on a cutter while it cuts
  double density = 1;              ///< g/cm³

  /// Throws std::invalid_argument naming `what` (a stock, or a fixture and its number) and the field.
  void validate(const std::string& what) const;
  /// Mass in g of `volume` mm³.
  double mass(double volume) const { return 1e-3 * density * volume; }
};

}  // namespace riffler::haptics
