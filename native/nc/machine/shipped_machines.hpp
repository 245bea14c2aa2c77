// The texts of native/nc/machine/shipped/*.toml, embedded in the library at build time.
#pragma once

#include <span>

#include "riffler/base/descriptions.hpp"

namespace riffler::nc {

/// In display order.
std::span<const base::ShippedText> shipped_machines();

}  // namespace riffler::nc
