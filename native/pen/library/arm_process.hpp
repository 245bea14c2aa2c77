// An arm that a maker's library drives, in a process of its own: the program riffler-arm (native/arm_program) loads the
// library and opens the arm, and exchanges readings and commands through shared memory. So a library that crashes or
// hangs takes nothing else with it, and one whose terms do not go with Riffler's licence is never in Riffler's process.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/child_process.hpp"
#include "base/shared_memory.hpp"
#include "pen/library/arm_channel.hpp"
#include "pen/link/transport.hpp"

namespace riffler::pen {

/// A library and how it is called.
struct ArmLibrary {
  std::string kind;      // "dhd" or "hd", the program's name for it
  std::string path;      // whole
  std::string install;   // remedy, where it cannot be loaded
  double patience = 10;  // s for it to open an arm
};

/// An arm that a search found.
struct FoundArm {
  std::string key;
  ArmTraits traits;
  OpenProblem problem = OpenProblem::None;
  std::string text;  // of the problem
};

/// The arms that the library finds; each is opened for a moment, without force, unless this process has it open.
/// Throws OpenError.
std::vector<FoundArm> list_arms(const ArmLibrary& library);

/// An arm that is open and takes force.
class ArmProcess final : public Transport {
 public:
  static constexpr double kEnd = 1;  // s for the library to close it; then the program is killed

  /// Opens the arm of that name (of its serial number or of the maker's configuration; empty: any). Throws OpenError.
  ArmProcess(const ArmLibrary& library, const std::string& name);
  /// Ends the force and closes the arm.
  ~ArmProcess() override;
  ArmProcess(const ArmProcess&) = delete;
  ArmProcess& operator=(const ArmProcess&) = delete;

  const ArmTraits& traits() const { return traits_; }
  /// Identifier of the program, for tests.
  int process() const noexcept { return program_->id(); }

  int read(std::span<std::uint8_t> bytes, double seconds) noexcept override;
  bool write(std::span<const std::uint8_t> bytes) noexcept override;

 private:
  ArmChannel& channel() const noexcept { return *static_cast<ArmChannel*>(memory_.data()); }

  base::SharedMemory memory_;
  std::unique_ptr<base::ChildProcess> program_;
  std::string held_;  // kind and key of the arm, which no second search shall open
  ArmTraits traits_;
  std::uint64_t seen_ = 0;  // ticket of the last reading that was read
};

}  // namespace riffler::pen
