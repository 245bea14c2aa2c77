// The texts of device/geometry/*.toml, embedded in the library at build time.
#pragma once

#include <span>

#include "riffler/base/descriptions.hpp"

namespace riffler::pen {

std::span<const base::ShippedText> shipped_pens();

}  // namespace riffler::pen
