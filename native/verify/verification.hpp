// Verification of programs while they are edited.
#pragma once

#include <optional>

#include "verify/edit.hpp"
#include "verify/slab_run.hpp"

namespace riffler::verify {

/// Of a program that is like the one before only what differs is simulated again. The report is that of a fresh run,
/// bit for bit.
class Verification {
 public:
  /// Throws std::invalid_argument naming the argument.
  explicit Verification(VerifyArguments arguments, const Progress& progress = {});

  /// Throws as SlabRun::feed. After that, or Cancelled, this is as it was before the call.
  VerifyReport run(const nc::Program& program, const Progress& progress = {});

 private:
  struct Memory {  // of the run before
    RunRows rows;
    std::vector<SlabState> slabs;
  };

  /// Which slabs can stay as they are, and from where on the others must be run again.
  std::vector<SlabState> resume(const RunRows& rows, VerifyStats& stats) const;

  std::shared_ptr<VerifyScene> scene_;
  std::optional<Memory> memory_;
};

}  // namespace riffler::verify
