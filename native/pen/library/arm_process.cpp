#include "pen/library/arm_process.hpp"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <new>
#include <set>
#include <system_error>
#include <utility>

#include "base/steady_clock.hpp"
#include "pen/library/arm_program_file.hpp"
#include "pen/link/deadline.hpp"

namespace riffler::pen {
namespace {

using Phase = ArmChannel::Phase;
constexpr double kLook = 0.02;  // s without a reading after which it is checked whether the program runs

/// The arms that this process has open, each as kind:key.
class HeldArms {
 public:
  void take(const std::string& arm) {
    const std::lock_guard lock(mutex_);
    arms_.insert(arm);
  }
  void give_back(const std::string& arm) {
    const std::lock_guard lock(mutex_);
    arms_.erase(arm);
  }
  std::vector<std::string> keys(const std::string& kind) {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> out;
    for (const std::string& arm : arms_)
      if (arm.starts_with(kind + ":")) out.push_back(arm.substr(kind.size() + 1));
    return out;
  }

 private:
  std::mutex mutex_;
  std::set<std::string> arms_;
};

HeldArms& held_arms() {
  static HeldArms arms;
  return arms;
}

std::unique_ptr<base::ChildProcess> start(const base::SharedMemory& memory, const ArmLibrary& library,
                                          const char* action, const std::string& name) {
  new (memory.data()) ArmChannel;
  std::vector<std::string> words{library.kind, action, library.path, name};
  for (std::string& key : held_arms().keys(library.kind)) words.push_back(std::move(key));
  const std::string file = arm_program_file();
  try {
    return std::make_unique<base::ChildProcess>(file, words, memory.file());
  } catch (const std::system_error& error) {
    throw OpenError(OpenProblem::Other, std::string("cannot start the program that loads the arm's library: ") +
                                            error.what() + "; install Riffler again, or set " + kArmProgramVariable +
                                            " to the whole path of riffler-arm");
  }
}

/// Waits until the program has opened or listed what it shall. Throws OpenError.
void await(ArmChannel& channel, base::ChildProcess& program, const ArmLibrary& library) {
  const Deadline deadline(library.patience);
  for (;;) {
    const std::uint32_t news = channel.news.load(std::memory_order_acquire);
    const bool ended = program.ended();  // before the look at the phase, which it sets first
    const Phase phase = channel.phase.load(std::memory_order_acquire);
    if (phase == Phase::Listed || phase == Phase::Open) return;
    if (phase == Phase::Failed) break;
    if (ended)
      throw OpenError(OpenProblem::Other, library.path + ": the program that loads it has not opened an arm: " +
                                              program.end_text() + "; is the library of another version?");
    if (deadline.left() <= 0)
      throw OpenError(OpenProblem::NoAnswer,
                      library.path + ": it has not answered in time, and was ended; switch the arm off and on");
    base::wait_for_change(channel.news, news, std::min(deadline.left(), kLook));
  }
  const bool missing = channel.problem == OpenProblem::NotInstalled || channel.problem == OpenProblem::WrongLibrary;
  throw OpenError(channel.problem, channel.text.get() + (missing ? "; " + library.install : std::string()));
}

}  // namespace

std::vector<FoundArm> list_arms(const ArmLibrary& library) {
  const base::SharedMemory memory(sizeof(ArmChannel));
  const std::unique_ptr<base::ChildProcess> program = start(memory, library, "list", "");
  ArmChannel& channel = *static_cast<ArmChannel*>(memory.data());
  await(channel, *program, library);
  program->wait(ArmProcess::kEnd);  // the arms are closed when it has ended
  std::vector<FoundArm> out;
  for (std::size_t k = 0; k < std::min<std::size_t>(channel.count, ArmChannel::kMostArms); ++k) {
    const SharedArm& arm = channel.arms[k];
    out.push_back({arm.key.get(), arm.traits(), arm.problem, arm.text.get()});
  }
  return out;
}

ArmProcess::ArmProcess(const ArmLibrary& library, const std::string& name) : memory_(sizeof(ArmChannel)) {
  program_ = start(memory_, library, "open", name);
  await(channel(), *program_, library);
  const SharedArm& arm = channel().arms[0];
  traits_ = arm.traits();
  held_ = library.kind + ":" + arm.key.get();
  held_arms().take(held_);
}

ArmProcess::~ArmProcess() {
  channel().end.store(true, std::memory_order_release);
  base::change(channel().wishes);
  program_->wait(kEnd);
  held_arms().give_back(held_);
}

int ArmProcess::read(std::span<std::uint8_t> bytes, double seconds) noexcept {
  ArmState state;
  if (bytes.size() < sizeof state) return -1;
  const Deadline deadline(seconds);
  for (;;) {
    const std::uint32_t news = channel().news.load(std::memory_order_acquire);
    if (const std::uint64_t ticket = channel().state.load(state); ticket != 0 && ticket != seen_) {
      seen_ = ticket;
      std::memcpy(bytes.data(), &state, sizeof state);
      return static_cast<int>(sizeof state);
    }
    if (channel().phase.load(std::memory_order_acquire) == Phase::Gone) return -1;
    const double left = deadline.left();
    if (left <= 0) return program_->ended() ? -1 : 0;
    base::wait_for_change(channel().news, news, std::min(left, kLook));
    if (left > kLook && channel().news.load(std::memory_order_acquire) == news && program_->ended()) return -1;
  }
}

bool ArmProcess::write(std::span<const std::uint8_t> bytes) noexcept {
  TimedCommand command;
  if (bytes.size() != sizeof command.wrench) return false;
  std::memcpy(&command.wrench, bytes.data(), sizeof command.wrench);
  command.time = base::steady_seconds();
  channel().command.store(command, channel().command.ticket() + 2);
  base::change(channel().wishes);
  return channel().phase.load(std::memory_order_acquire) == Phase::Open;
}

}  // namespace riffler::pen
