// The texts of native/nc/machine/shipped/*.toml, which the build puts into the library.
#pragma once

#include <span>

#include "riffler/base/descriptions.hpp"

namespace riffler::nc {

/// In the order in which a list shows them.
std::span<const base::ShippedText> shipped_machines();

}  // namespace riffler::nc
