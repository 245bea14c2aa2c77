#include "base/real_time.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "base/posix/overrun_guard.hpp"
#include "base/posix/rtkit.hpp"
#include "base/posix/system_bus.hpp"

namespace riffler::base {

namespace {

constexpr const char* kRemedy =
    "write the line \"@audio - rtprio 20\" to /etc/security/limits.d/riffler.conf, add yourself to the group audio "
    "(usermod -aG audio NAME) and log in again; or install rtkit";

ThreadPriority granted(int level, ThreadPriority::By by) {
  return {level, by,
          "real time, level " + std::to_string(level) +
              (by == ThreadPriority::By::Rtkit ? ", granted by rtkit" : ", granted by the system")};
}

ThreadPriority refused(const std::string& why, std::string remedy = kRemedy) {
  return {0, ThreadPriority::By::Nobody, "normal: " + why, std::move(remedy)};
}

/// The highest level within RLIMIT_RTPRIO that is at most `wanted`; 0 for none.
int level_within_limit(int wanted) {
  rlimit limit{};
  if (getrlimit(RLIMIT_RTPRIO, &limit) != 0) return 0;
  return static_cast<int>(std::min<rlim_t>(limit.rlim_cur, static_cast<rlim_t>(wanted)));
}

/// Asks the system for a real-time level. Returns the granted level and 0, or 0 and the errno.
std::pair<int, int> ask_system(int wanted) {
  const int error = schedule_thread(0, wanted);
  if (error == 0) return {wanted, 0};
  const int within = level_within_limit(wanted);
  if (within > 0 && schedule_thread(0, within) == 0) return {within, 0};
  return {0, error};
}

}  // namespace

class RealTimeScope::Grant {
 public:
  Grant(PriorityReport& report, const RealTimeSettings& settings);
  ~Grant();
  void wait();

 private:
  void ask_rtkit(int thread, const RealTimeSettings& settings) noexcept;

  PriorityReport& report_;
  OverrunGuard guard_;
  std::unique_ptr<BusCancel> cancel_;
  std::thread asker_;
};

RealTimeScope::Grant::Grant(PriorityReport& report, const RealTimeSettings& settings)
    : report_(report), guard_(report.overran(), settings.guard) {
  const char* const wanted = std::getenv("RIFFLER_REAL_TIME");
  if (wanted != nullptr && std::strcmp(wanted, "0") == 0) {
    report_.set(refused("RIFFLER_REAL_TIME is 0", ""));
    return;
  }
  if (!guard_.guards()) {
    report_.set(refused("the system does not limit how long a thread may run", ""));
    return;
  }
  const auto [level, error] = ask_system(settings.level);
  if (level > 0) {
    report_.set(granted(level, ThreadPriority::By::System));
    return;
  }
  report_.set(refused(std::string("the system refuses real time: ") + std::strerror(error)));
  try {
    cancel_ = std::make_unique<BusCancel>();
    asker_ = std::thread([this, settings, thread = thread_number()] { ask_rtkit(thread, settings); });
  } catch (const std::system_error&) {
    // No thread to ask rtkit: the report keeps the system's refusal.
  }
}

RealTimeScope::Grant::~Grant() {
  if (cancel_) cancel_->cancel();
  wait();
  if (guard_.guards()) schedule_thread(0, 0);
}

void RealTimeScope::Grant::wait() {
  if (asker_.joinable()) asker_.join();
}

void RealTimeScope::Grant::ask_rtkit(int thread, const RealTimeSettings& settings) noexcept {
  try {
    Rtkit rtkit(settings.bus.empty() ? system_bus_address() : settings.bus, settings.answer, *cancel_);
    const RtkitLimits limits = rtkit.limits();
    const int level = std::min(settings.level, limits.level);
    if (!OverrunGuard::lower_hard_limit(limits.microseconds)) throw BusError("the system refuses rtkit's limit");
    rtkit.make_real_time(thread, level);
    if (!is_real_time(thread)) throw BusError("rtkit agreed, but the thread has no real-time priority");
    report_.set(granted(level, ThreadPriority::By::Rtkit));
  } catch (const std::exception& error) {
    report_.set(refused(std::string("the system refuses real time; ") + error.what()));
  }
}

RealTimeScope::RealTimeScope(PriorityReport& report, const RealTimeSettings& settings)
    : grant_(std::make_unique<Grant>(report, settings)) {}

RealTimeScope::~RealTimeScope() = default;

void RealTimeScope::wait() {
  grant_->wait();
}

ThreadPriority probe_real_time(const RealTimeSettings& settings) {
  PriorityReport report;
  std::thread([&] { RealTimeScope(report, settings).wait(); }).join();
  return report.get();
}

}  // namespace riffler::base
