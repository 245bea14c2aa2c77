// What a stock or a fixture is made of, as far as a hand can feel it.
#pragma once

#include <string>

namespace riffler::haptics {

struct Material {
  double stiffness = 1;            ///< of its surface, N per mm of depth and mm²; of a fixture, N per mm³ in the tool
  double removal_constant = 0.05;  ///< N·s/mm³: force per volume removed per second
  double damping = 0;              ///< N·s/mm: what rubs on a cutter in the cut, besides
  double density = 1;              ///< g/cm³

  /// std::invalid_argument naming what (a stock, a fixture and its number) and the field.
  void validate(const std::string& what) const;
  /// g of so many mm³.
  double mass(double volume) const { return 1e-3 * density * volume; }
};

}  // namespace riffler::haptics
