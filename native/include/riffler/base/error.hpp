// The exceptions of the core. Bindings map them one to one: std::invalid_argument → ValueError.
#pragma once

#include <stdexcept>
#include <string>

namespace riffler::base {

/// A file that cannot be read: `file` (base name), `where` ("line 12" or "byte 84") and what was expected there.
class FormatError : public std::runtime_error {
 public:
  FormatError(const std::string& file, const std::string& where, const std::string& what)
      : std::runtime_error(file + (where.empty() ? "" : ", " + where) + ": " + what) {}
};

/// A long call that its progress callback stopped; the object is as it was before the call.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace riffler::base

namespace riffler {
using base::Cancelled;
using base::FormatError;
}  // namespace riffler
