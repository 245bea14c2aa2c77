// The exceptions of the core. The bindings map each to one Python exception: std::invalid_argument → ValueError.
#pragma once

#include <stdexcept>
#include <string>

namespace riffler::base {

/// A file is malformed. `file`: base name; `where`: "line 12" or "byte 84"; `what`: what was expected there.
class FormatError : public std::runtime_error {
 public:
  FormatError(const std::string& file, const std::string& where, const std::string& what)
      : std::runtime_error(file + (where.empty() ? "" : ", " + where) + ": " + what) {}
};

/// The progress callback stopped a long call. The call's object is unchanged.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace riffler::base

namespace riffler {
using base::Cancelled;
using base::FormatError;
}  // namespace riffler
