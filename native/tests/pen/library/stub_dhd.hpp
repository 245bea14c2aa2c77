// What a test may say to the stub of libdhd, and learn from it.
#pragma once

#include <atomic>
#include <chrono>

namespace riffler::test {

/// One arm. Positions in m, in the library's axes: x towards the user, y right, z up.
struct StubArm {
  std::atomic<double> position[3] = {0.01, 0.02, 0.03}, velocity[3] = {0, 0, 0};
  std::atomic<double> frame[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  std::atomic<double> force[3] = {0, 0, 0}, torque[3] = {0, 0, 0};
  std::atomic<unsigned> buttons{0};
  std::atomic<int> serial{0}, watchdog{0};  // watchdog: multiples of 125 µs
  std::atomic<bool> plugged{true}, wrist{true}, active{true}, open{false}, enabled{false};
  std::atomic<bool> power{true}, reset{false}, button_off{false}, error{false};
  std::atomic<bool> crashes{false}, hangs{false};  // the next call
  std::atomic<long long> commanded{0};             // ns of the steady clock
  std::atomic<int> commands{0}, opened{0};
};

inline long long stub_now() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// The arm's own watchdog ends the force.
inline void watch(StubArm& arm) {
  if (arm.watchdog > 0 && stub_now() - arm.commanded > 125'000LL * arm.watchdog)
    for (auto* values : {arm.force, arm.torque})
      for (int k = 0; k < 3; ++k) values[k] = 0;
}

struct StubDhd {
  static constexpr const char* kVariable = "RIFFLER_STUB_DHD";  // names the file in which it lies
  std::atomic<int> count{1};
  StubArm arms[2];
};

}  // namespace riffler::test
