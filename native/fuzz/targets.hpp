// What is fuzzed: every reader of bytes that others make.
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

/// A reader took bytes and made something of them that must not be.
class Broken : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

struct Target {
  const char* name;  ///< also of its folders in native/fuzz/seeds and native/fuzz/kept
  /// Reads. The errors that readers promise are fine; Broken and all others are not.
  void (*run)(View bytes);
  /// Files that the library itself writes, to begin with; more are in native/fuzz/seeds.
  std::vector<Bytes> (*made)();
  /// Makes the lengths and checksums right that a mutation has made wrong, where bytes have them; or null.
  void (*repair)(Bytes& bytes);
};

std::span<const Target> targets();
/// std::invalid_argument, naming those that there are.
const Target& target(std::string_view name);

}  // namespace riffler::fuzz
