// Where programmed coordinates are on the machine: work offset with rotation, G92 offset, and what the tool's tip is
// off by.
#pragma once

#include "nc/machine/machine.hpp"

namespace riffler::nc {

/// Machine position of the tip = turn(program + shift) + origin + tip, the turn about Z by `rotation` degrees; rotary
/// axes without turn and tip.
struct NcFrame {
  Joints origin{};      ///< of the system in use (G54 … G59.3)
  double rotation = 0;  ///< deg, of that system (G10 L2 R)
  Joints shift{};       ///< G92, G52
  Vec3 tip{0};          ///< mm by which a dynamic tool offset (G43.1) differs from the tool's own

  bool operator==(const NcFrame&) const = default;

  Joints to_machine(const Joints& program) const;
  Joints to_program(const Joints& machine) const;
};

/// `vector` in the XY plane turned by `degrees`.
Vec2 turned_in_plane(const Vec2& vector, double degrees);

}  // namespace riffler::nc
