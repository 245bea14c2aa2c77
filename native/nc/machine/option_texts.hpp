// Descriptions of the options of machines and posts, from which panels build their fields.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "nc/options.hpp"

namespace riffler::nc {

/// An option of a machine, or of the code written for it.
struct MachineOption {
  OptionFact fact;
  std::string unit;  ///< "mm", "deg", "deg/min", "mm/min" or empty
  bool own = false;  ///< declared in this machine's file; the others are common to many machines
};

/// All options of machine `name` given `options`, its own first. Which options are required depends on the ones given.
/// Throws as make_machine, except for missing options.
std::vector<MachineOption> machine_options(std::string_view name, Options options = {});

}  // namespace riffler::nc
