// What Riffler and the program riffler-arm, which loads a maker's library, share in memory: the arms that the program
// found, and, of an open one, the newest reading and the newest command.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "pen/library/arm_state.hpp"
#include "riffler/base/sequence_lock.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {

/// A text of at most N − 1 bytes; what is longer is cut off.
template <std::size_t N>
class SharedText {
 public:
  void set(std::string_view text) noexcept {
    const std::size_t length = text.copy(bytes_.data(), N - 1);
    bytes_[length] = '\0';
  }
  std::string get() const {
    const std::string_view whole(bytes_.data(), N);
    return std::string(whole.substr(0, whole.find('\0')));
  }

 private:
  std::array<char, N> bytes_;
};

/// One arm as found, or why it could not be opened.
struct SharedArm {
  SharedText<64> key;  // by which the library opens it
  SharedText<64> name, serial;
  SharedText<256> about, text;
  OpenProblem problem;
  Vec3 own_axis, lower, upper;
  double force, continuous, torque;

  void set(const ArmTraits& traits) noexcept;
  ArmTraits traits() const;
};

/// A command and when it was given, by base::steady_seconds.
struct TimedCommand {
  ArmCommand wrench;
  double time = -1e300;
};

struct ArmChannel {
  static constexpr std::uint32_t kVersion = 1;
  static constexpr std::size_t kMostArms = 16;
  static constexpr double kHeld = 0.02;  // s for which a command holds
  enum class Phase : std::uint32_t {
    Starting,
    Failed,  // `problem` and `text` say why
    Listed,  // `arms` are all; the program ends
    Open,    // the first of `arms` is open, and its force is on
    Gone,    // the arm does not answer any more; the program ends
  };

  std::uint32_t version = kVersion;

  // Written by the program. The phase is set after all that it speaks of.
  alignas(64) std::atomic<std::uint32_t> news{0};  // changed with each reading and phase
  std::atomic<Phase> phase{Phase::Starting};
  base::SequenceLock<ArmState> state;
  std::uint32_t count = 0;  // of arms
  std::array<SharedArm, kMostArms> arms{};
  OpenProblem problem = OpenProblem::None;
  SharedText<1024> text{};

  // Written by Riffler.
  alignas(64) std::atomic<std::uint32_t> wishes{0};  // changed with each command and by the end
  std::atomic<bool> end{false};
  base::SequenceLock<TimedCommand> command;
};

}  // namespace riffler::pen
