// The texts of native/nc/machines/*.toml, which the build puts into the library.
#pragma once

#include <span>
#include <string_view>

namespace riffler {

struct ShippedMachine {
  std::string_view name, toml;
};

/// In the order in which a list shows them.
std::span<const ShippedMachine> shipped_machines();

}  // namespace riffler
