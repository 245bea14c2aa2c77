// Targets of fuzzing: every reader of bytes from outside.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace riffler::fuzz {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

/// A reader accepted bytes and returned an invalid result.
class Broken : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

struct Target {
  const char* name;  ///< also the name of its folders in native/fuzz/seeds and native/fuzz/kept
  /// Runs the reader. Errors that readers promise are allowed; Broken and all others are failures.
  void (*run)(View bytes);
  /// First inputs, written by the library itself; more are in native/fuzz/seeds.
  std::vector<Bytes> (*made)();
  /// Corrects lengths and checksums after a mutation; null for formats without them.
  void (*repair)(Bytes& bytes);
};

std::span<const Target> targets();
/// Throws std::invalid_argument listing the known targets.
const Target& target(std::string_view name);

}  // namespace riffler::fuzz
