// What the options of machines and posts are, for people: fields of a panel are made from it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "nc/options.hpp"

namespace riffler::nc {

/// An option of a machine, or of the code that is written for it.
struct MachineOption {
  OptionFact fact;
  std::string unit;  ///< "mm", "deg", "deg/min", "mm/min" or nothing
  bool own = false;  ///< of this machine's file; the others are of many
};

/// All options of machine `name`, its own first, as they are with these `options`: which ones must be given depends on
/// them. Throws what make_machine throws, but for options that are missing.
std::vector<MachineOption> machine_options(std::string_view name, Options options = {});

}  // namespace riffler::nc
