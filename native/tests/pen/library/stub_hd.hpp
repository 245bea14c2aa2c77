// What a test may say to the stub of libHD, and learn from it.
#pragma once

#include <atomic>

namespace riffler::test {

/// One arm. Positions in mm, in the library's axes: x right, y up, z towards the user.
struct StubTouch {
  std::atomic<double> position[3] = {10, 20, 30}, velocity[3] = {0, 0, 0};
  std::atomic<double> transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // column by column
  std::atomic<double> force[3] = {0, 0, 0}, max_force{3.3}, continuous{0.88};
  std::atomic<int> buttons{0}, calibration{0x5000}, updates{0};
  std::atomic<unsigned> error{0};  // the next hdGetError returns it once
  std::atomic<bool> plugged{true}, stalled{false}, output{false}, open{false}, runs{false};
  std::atomic<int> frames{0}, outside{0};  // outside: calls that need a frame, without one
  char name[64] = "";                      // asked of hdInitDevice
};

struct StubHd {
  static constexpr const char* kVariable = "RIFFLER_STUB_HD";  // names the file in which it lies
  StubTouch arms[2];                                           // the second is "Left Device"
};

}  // namespace riffler::test
