// rtkit, the service by which desktops grant real-time priority to programs of their users.
#pragma once

#include <sys/types.h>

#include <string>

#include "base/posix/system_bus.hpp"

namespace riffler::base {

/// What rtkit allows.
struct RtkitLimits {
  int level = 0;                  ///< the highest of SCHED_RR
  std::int64_t microseconds = 0;  ///< that RLIMIT_RTTIME of the process must not exceed
};

/// A connection to the service.
class Rtkit {
 public:
  /// As SystemBus.
  Rtkit(const std::string& address, double seconds, const BusCancel& cancel) : bus_(address, seconds, cancel) {}

  /// Throws BusError.
  RtkitLimits limits();
  /// Makes a thread of this process SCHED_RR. Throws BusError with the reason.
  void make_real_time(pid_t thread, int level);

 private:
  std::int64_t property(const char* name);
  DbusMessage ask(DbusCall call);

  SystemBus bus_;
};

}  // namespace riffler::base
