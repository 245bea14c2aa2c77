// Verification of a program, repeated incrementally while it is edited.
#pragma once

#include <memory>

#include "riffler/base/progress.hpp"
#include "riffler/nc/program.hpp"
#include "riffler/verify/arguments.hpp"
#include "riffler/verify/report.hpp"

namespace riffler::verify {

/// Verifies programs. For a program similar to the last one, only the differences are simulated; the report is
/// bit-identical to that of a fresh run.
class Verification {
 public:
  /// Throws std::invalid_argument naming the argument.
  explicit Verification(VerifyArguments arguments, const Progress& progress = {});
  ~Verification();
  Verification(Verification&&) noexcept;
  Verification& operator=(Verification&&) noexcept;

  /// Verifies `program`. Errors as SlabRun::feed. After an exception, including Cancelled, this object is as it was
  /// before the call.
  VerifyReport run(const nc::Program& program, const Progress& progress = {});

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace riffler::verify
