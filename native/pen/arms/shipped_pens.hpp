// The texts of device/geometry/*.toml, which the build puts into the library.
#pragma once

#include <span>

#include "riffler/base/descriptions.hpp"

namespace riffler::pen {

std::span<const base::ShippedText> shipped_pens();

}  // namespace riffler::pen
