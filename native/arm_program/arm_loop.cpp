#include "arm_program/arm_loop.hpp"

#include <unistd.h>

#include <algorithm>
#include <optional>

#include "base/real_time.hpp"
#include "base/shared_memory.hpp"
#include "base/steady_clock.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::arm_program {
namespace {

using base::steady_seconds;
using pen::ArmChannel;
using pen::OpenError;
using pen::OpenProblem;

constexpr double kLongestWait = 0.005;  // s: largest delay in ending an old command and in noticing Riffler's exit
constexpr double kOrphanCheck = 0.1;    // s

std::unique_ptr<LibraryArm> open_key(Library& library, const std::string& key, const std::vector<std::string>& held) {
  if (std::find(held.begin(), held.end(), key) != held.end())
    throw OpenError(OpenProblem::Busy, "Riffler itself has the arm open; end that session first");
  return library.open(key);
}

/// Opens the arm of that name and returns it with its key. Throws the error of the first arm that does not open.
std::unique_ptr<LibraryArm> open_named(Library& library, const std::string& name, const std::vector<std::string>& held,
                                       std::string& key) {
  std::optional<OpenError> first;
  for (const std::string& one : library.keys(name)) {
    try {
      std::unique_ptr<LibraryArm> arm = open_key(library, one, held);
      key = one;
      if (library.is(arm->traits(), name)) return arm;
    } catch (const OpenError& error) {
      if (!first) first = error;
    }
  }
  if (first) throw OpenError(first->problem(), first->what());
  throw OpenError(OpenProblem::NoFile, library.none(name));
}

/// Sends the newest command to the arm, and zero force once it is too old.
class Commands {
 public:
  explicit Commands(const ArmChannel& channel) : channel_(channel) {}

  /// False if the arm is gone.
  bool pass_on(LibraryArm& arm) noexcept {
    if (const std::uint64_t ticket = channel_.command.load(command_); ticket != 0 && ticket != seen_) {
      seen_ = ticket;
      pushes_ = true;
      if (fresh()) return arm.push(command_.wrench);
    }
    if (!pushes_ || fresh()) return true;
    pushes_ = false;
    return arm.push({});
  }

 private:
  bool fresh() const noexcept { return steady_seconds() - command_.time <= ArmChannel::kHeld; }

  const ArmChannel& channel_;
  pen::TimedCommand command_;
  std::uint64_t seen_ = 0;
  bool pushes_ = false;
};

/// True while the process that started this one runs.
class Parent {
 public:
  bool runs() noexcept {
    const double now = steady_seconds();
    if (now < due_) return runs_;
    due_ = now + kOrphanCheck;
    return runs_ = ::getppid() == process_;
  }

 private:
  pid_t process_ = ::getppid();
  double due_ = 0;
  bool runs_ = true;
};

}  // namespace

void set_phase(ArmChannel& channel, ArmChannel::Phase phase) {
  channel.phase.store(phase, std::memory_order_release);
  base::change(channel.news);
}

void list(Library& library, const std::vector<std::string>& held, ArmChannel& channel) {
  for (const std::string& key : library.keys("")) {
    if (channel.count == ArmChannel::kMostArms) break;
    pen::SharedArm& out = channel.arms[channel.count++];
    out.key.set(key);
    try {
      out.set(open_key(library, key, held)->traits());
    } catch (const OpenError& error) {
      out.problem = error.problem();
      out.text.set(error.what());
    }
  }
  set_phase(channel, ArmChannel::Phase::Listed);
}

void serve(Library& library, const std::string& name, const std::vector<std::string>& held, ArmChannel& channel) {
  std::string key;
  const std::unique_ptr<LibraryArm> arm = open_named(library, name, held, key);
  arm->enable();
  base::PriorityReport report;
  const base::RealTimeScope real_time(report);
  channel.arms[0].key.set(key);
  channel.arms[0].set(arm->traits());
  channel.count = 1;
  set_phase(channel, ArmChannel::Phase::Open);
  Commands commands(channel);
  Parent parent;
  pen::ArmState state;
  while (!channel.end.load(std::memory_order_acquire) && parent.runs()) {
    const std::uint32_t wishes = channel.wishes.load(std::memory_order_acquire);
    const Reading reading = arm->read(state);
    if (reading == Reading::Gone || !commands.pass_on(*arm)) return set_phase(channel, ArmChannel::Phase::Gone);
    if (reading == Reading::New) {
      channel.state.store(state, channel.state.ticket() + 2);
      base::change(channel.news);
    }
    base::wait_for_change(channel.wishes, wishes, std::min(arm->due(), kLongestWait));
  }
}

}  // namespace riffler::arm_program
