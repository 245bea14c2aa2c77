// Options for opening a device.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "riffler/pen/arms/compensation.hpp"
#include "riffler/pen/driver_settings.hpp"
#include "riffler/pen/models/rate_control.hpp"

namespace riffler::pen {

/// Options of all kinds of devices; each kind reads its own.
struct PenOptions {
  RateSettings rate{};                     ///< for pucks
  std::string geometry = "woodenhaptics";  ///< for the Polhem protocol: "woodenhaptics" or "polhem-1"
  CompensationShares compensation{};       ///< for Riffler's pen, including the simulated one
  std::optional<std::uint64_t> seed{};     ///< for the simulated pen: true values drawn at random around the described
  bool real_time = true;                   ///< for the simulated pen: false, as fast as the machine computes
  DriverSettings driver{};
};

}  // namespace riffler::pen
