// Verification of a program, and again while it is edited.
#pragma once

#include <memory>

#include "riffler/base/progress.hpp"
#include "riffler/nc/program.hpp"
#include "riffler/verify/arguments.hpp"
#include "riffler/verify/report.hpp"

namespace riffler::verify {

/// Verifies a program. Of the next one that is like it, only what differs is simulated. The report is that of a fresh
/// run, bit for bit.
class Verification {
 public:
  /// Throws std::invalid_argument naming the argument.
  explicit Verification(VerifyArguments arguments, const Progress& progress = {});
  ~Verification();
  Verification(Verification&&) noexcept;
  Verification& operator=(Verification&&) noexcept;

  /// Throws as SlabRun::feed. After that, or Cancelled, this is as it was before the call.
  VerifyReport run(const nc::Program& program, const Progress& progress = {});

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace riffler::verify
