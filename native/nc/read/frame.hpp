// From programmed to machine coordinates: work offset with rotation, G92 offset, and offset of the tool's tip.
#pragma once

#include "nc/machine/machine.hpp"

namespace riffler::nc {

/// Machine position of the tip = turn(program + shift) + origin + tip, where turn rotates about Z by `rotation`
/// degrees. Rotary axes have neither turn nor tip.
struct NcFrame {
  Joints origin{};      ///< of the active system (G54 … G59.3)
  double rotation = 0;  ///< deg, of that system (G10 L2 R)
  Joints shift{};       ///< G92, G52
  Vec3 tip{0};          ///< mm: difference of a dynamic tool offset (G43.1) from the tool's own

  bool operator==(const NcFrame&) const = default;

  Joints to_machine(const Joints& program) const;
  Joints to_program(const Joints& machine) const;
};

/// `vector` in the XY plane, rotated by `degrees`.
Vec2 turned_in_plane(const Vec2& vector, double degrees);

}  // namespace riffler::nc
