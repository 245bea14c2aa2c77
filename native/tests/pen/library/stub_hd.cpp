// A stub with the names of OpenHaptics' libHD that Riffler calls, for tests: two arms in memory that the test
// shares, of which a process opens one, and a scheduler with a
// thread. Names and meanings are those of the maker's published headers (OpenHaptics 3.0); nothing else of it is here.
#include "pen/library/stub_hd.hpp"

#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>

#include "pen/library/stub_state.hpp"

using riffler::test::StubHd;
using riffler::test::StubTouch;

namespace {

struct ErrorInfo {
  unsigned code;
  int internal;
  unsigned device;
};
using Callback = unsigned (*)(void*);

StubTouch* stub = &riffler::test::stub_state<StubHd>().arms[0];
std::mutex mutex;
Callback callback = nullptr;
void* callback_data = nullptr;
std::thread scheduler;
thread_local bool in_frame = false;

void needs_frame() {
  if (!in_frame) ++stub->outside;
}

void serve() {
  while (stub->runs) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (stub->stalled) continue;
    const std::lock_guard lock(mutex);
    if (callback != nullptr && callback(callback_data) == 0) callback = nullptr;
  }
}

void give(const std::atomic<double>* from, int count, double* to) {
  for (int k = 0; k < count; ++k) to[k] = from[k];
}

}  // namespace

#define STUB extern "C" __attribute__((visibility("default")))

STUB unsigned hdInitDevice(const char* name) {
  stub = &riffler::test::stub_state<StubHd>().arms[name != nullptr && std::strcmp(name, "Left Device") == 0];
  std::strncpy(stub->name, name == nullptr ? "" : name, sizeof stub->name - 1);
  if (!stub->plugged || stub->open) {
    stub->error = stub->open ? 0x0301 : 0x0302;
    return 0xFFFFFFFF;
  }
  stub->open = true;
  return 7;
}

STUB void hdDisableDevice(unsigned) {
  stub->open = stub->output = false;
  for (auto& f : stub->force) f = 0;
}

STUB void hdMakeCurrentDevice(unsigned) {}

STUB void hdBeginFrame(unsigned) {
  in_frame = true;
  ++stub->frames;
  if (!stub->plugged) stub->error = 0x0302;  // HD_COMM_ERROR
}

STUB void hdEndFrame(unsigned) {
  in_frame = false;
}

STUB ErrorInfo hdGetError() {
  return {stub->error.exchange(0), 0, 7};
}

STUB const char* hdGetErrorString(unsigned code) {
  return code == 0x0302 ? "HD_COMM_ERROR" : "HD_OTHER_ERROR";
}

STUB void hdEnable(unsigned capability) {
  if (capability == 0x4000) stub->output = true;
}

STUB void hdDisable(unsigned capability) {
  if (capability != 0x4000) return;
  stub->output = false;
  for (auto& f : stub->force) f = 0;
}

STUB unsigned char hdIsEnabled(unsigned capability) {
  return capability == 0x4000 && stub->output;
}

STUB void hdGetDoublev(unsigned name, double* values) {
  const double box[6] = {-160, -60, -35, 160, 120, 35};
  switch (name) {
    case 0x2050:
      return needs_frame(), give(stub->position, 3, values);
    case 0x2051:
      return needs_frame(), give(stub->velocity, 3, values);
    case 0x2052:
      return needs_frame(), give(stub->transform, 16, values);
    case 0x2603:
      *values = stub->max_force;
      return;
    case 0x2604:
      *values = stub->continuous;
      return;
    case 0x2551:
      std::memcpy(values, box, sizeof box);
      return;
    default:
      stub->error = 0x0100;  // HD_INVALID_ENUM
  }
}

STUB void hdGetIntegerv(unsigned name, int* values) {
  if (name == 0x2000)
    needs_frame(), *values = stub->buttons;
  else if (name == 0x2555)
    *values = 1 << 2;
  else
    stub->error = 0x0100;
}

STUB const char* hdGetString(unsigned name) {
  return name == 0x2501 ? "Touch" : name == 0x2504 ? "70001" : nullptr;
}

STUB void hdSetDoublev(unsigned name, const double* values) {
  needs_frame();
  if (name == 0x2700)
    for (int k = 0; k < 3; ++k) stub->force[k] = stub->output ? values[k] : 0;
}

STUB unsigned hdCheckCalibration() {
  return static_cast<unsigned>(stub->calibration.load());
}

STUB void hdUpdateCalibration(unsigned style) {
  if (style == 1 << 2) ++stub->updates, stub->calibration = 0x5000;
}

STUB void hdStartScheduler() {
  if (stub->runs.exchange(true)) return;
  scheduler = std::thread(serve);
}

STUB void hdStopScheduler() {
  if (stub->runs.exchange(false)) scheduler.join();
}

STUB unsigned long hdScheduleAsynchronous(Callback called, void* data, unsigned short) {
  const std::lock_guard lock(mutex);
  callback = called, callback_data = data;
  return 3;
}

STUB void hdUnschedule(unsigned long) {
  const std::lock_guard lock(mutex);
  callback = nullptr;
}
