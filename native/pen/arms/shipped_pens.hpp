// The texts of device/geometry/*.toml, which the build puts into the library.
#pragma once

#include <span>

#include "riffler/base/descriptions.hpp"

namespace riffler {

std::span<const ShippedText> shipped_pens();

}  // namespace riffler
