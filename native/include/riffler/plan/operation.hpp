// Operations: what a tool does on a part in one set-up, with approaches, links and retracts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::plan {

/// What an operation works on: one frame, mm.
struct SetupScene {
  Mesh part;
  std::vector<Mesh> fixtures;
  Volume stock;          ///< at the beginning of the operation
  Vec3 axis{0, 0, 1};    ///< unit vector from tip to spindle
  double clearance = 5;  ///< mm above part, stock and fixtures along the axis: rapids across happen there
};

/// What a move of an operation is.
enum class MoveKind : std::uint8_t { Rapid, Lead, Cut, Link };

/// Why and where the tool does not cut.
struct BlockedPlace {
  std::string reason;
  Vec3 place{0};      ///< tip of the tool at the first of these places, mm
  double length = 0;  ///< mm of rows that are left out
};

/// The moves of an operation, which begins and ends on the clearance plane.
struct Operation {
  std::vector<Pose> poses;
  std::vector<MoveKind> kinds;  ///< of the move that ends at the pose
  std::vector<double> feeds;    ///< mm/min; 0 for rapids
  std::vector<BlockedPlace> blocked;
  std::string reason;  ///< why there are no poses; empty if there are some
};

}  // namespace riffler::plan
