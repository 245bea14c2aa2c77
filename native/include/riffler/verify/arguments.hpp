// Arguments of a verification.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/vec.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/nc/option_values.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::verify {

/// The machine that runs a program: a name from machines() or the path of a description, and its options.
struct MachineChoice {
  std::string name;
  nc::Options options;
  /// From the verified coordinates to those of the machine's program: p → turn p + shift (mm).
  Mat3 turn{1};
  Vec3 shift{0};
};

/// Tolerances and the optional machine of a verification.
struct VerifyOptions {
  double tolerance = 0.01;               ///< mm: as CarveOptions::tolerance; contact less deep than this is ignored
  double gouge_tolerance = 0.05;         ///< mm below the part's surface
  std::optional<double> rest_tolerance;  ///< mm above the part's surface; by default rest material is not a fault
  double rapid_feed = 10'000;            ///< mm/min, for the duration of rapids
  /// The machine for limit checks; without one, limits are not checked. Each chunk of a program is checked by itself.
  std::optional<MachineChoice> machine = {};
};

/// Everything a verification needs except the program.
struct VerifyArguments {
  Volume stock;
  std::shared_ptr<const Mesh> part = {};  ///< may be null
  std::vector<Volume> fixtures = {};
  std::map<int, Tool> tools = {};  ///< take precedence over the program's own
  VerifyOptions options = {};
};

}  // namespace riffler::verify
