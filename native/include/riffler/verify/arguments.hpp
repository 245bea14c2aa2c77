// What a verification is given.
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

/// What a program is to run on: a name of machines(), or the path of a description, and its options.
struct MachineChoice {
  std::string name;
  nc::Options options;
  /// From the verified coordinates to those that the machine's program is in: p → turn p + shift.
  Mat3 turn{1};
  Vec3 shift{0};
};

struct VerifyOptions {
  double tolerance = 0.01;               ///< mm: as CarveOptions::tolerance; contact less deep than it is none
  double gouge_tolerance = 0.05;         ///< mm under the part's surface
  std::optional<double> rest_tolerance;  ///< mm over the part's surface; without it rest material is no fault
  double rapid_feed = 10'000;            ///< mm/min, for the time that rapids take
  /// On which it is to run; without it limits are not checked. Chunks of a program are checked one by one.
  std::optional<MachineChoice> machine = {};
};

/// What a verification is given but for the program.
struct VerifyArguments {
  Volume stock;
  std::shared_ptr<const Mesh> part = {};  ///< may be null
  std::vector<Volume> fixtures = {};
  std::map<int, Tool> tools = {};  ///< they come before a program's own
  VerifyOptions options = {};
};

}  // namespace riffler::verify
