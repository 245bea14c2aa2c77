#include "base/real_time.hpp"

// windows.h first: it declares what the others use.
#include <windows.h>

#include <mmsystem.h>

#include <thread>

#include "base/environment.hpp"
#include "base/windows/wide.hpp"

namespace riffler::base {

/// The highest priority that a program without rights of its own gets, and timers of 1 ms instead of 15.6 ms.
class RealTimeScope::Grant {
 public:
  explicit Grant(PriorityReport& report) : timers_(timeBeginPeriod(1) == TIMERR_NOERROR) {
    if (environment("RIFFLER_REAL_TIME") == "0") {
      report.set({0, ThreadPriority::By::Nobody, "normal: RIFFLER_REAL_TIME is 0", {}});
      return;
    }
    before_ = GetThreadPriority(GetCurrentThread());
    raised_ = SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_TIME_CRITICAL);
    if (raised_)
      report.set({15, ThreadPriority::By::System, "time-critical, granted by the system", {}});
    else
      report.set({0, ThreadPriority::By::Nobody, "normal: the system refuses it: " + error_text(last_error()), {}});
  }
  ~Grant() {
    if (raised_) SetThreadPriority(GetCurrentThread(), before_);
    if (timers_) timeEndPeriod(1);
  }

 private:
  bool timers_, raised_ = false;
  int before_ = THREAD_PRIORITY_NORMAL;
};

RealTimeScope::RealTimeScope(PriorityReport& report, const RealTimeSettings&)
    : grant_(std::make_unique<Grant>(report)) {}

RealTimeScope::~RealTimeScope() = default;

void RealTimeScope::wait() {}

ThreadPriority probe_real_time(const RealTimeSettings& settings) {
  PriorityReport report;
  std::thread([&] { RealTimeScope(report, settings).wait(); }).join();
  return report.get();
}

}  // namespace riffler::base
