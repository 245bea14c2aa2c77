#include "base/environment.hpp"

#include <cstdlib>

namespace riffler::base {

std::optional<std::string> environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? std::optional<std::string>(value) : std::nullopt;
}

}  // namespace riffler::base
