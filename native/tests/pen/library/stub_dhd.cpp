// A stub with the names of Force Dimension's libdhd that Riffler calls, for tests: two arms in memory that the test
// shares. Names and meanings are those of the maker's published header (Haptic SDK 3.7); nothing else of it is here.
#include "pen/library/stub_dhd.hpp"

#include <thread>

#include "pen/library/stub_state.hpp"

using riffler::test::StubArm;
using riffler::test::StubDhd;

namespace {

StubDhd& stub = riffler::test::stub_state<StubDhd>();
thread_local const char* last_error = "no error";

int refuse(const char* why) {
  last_error = why;
  return -1;
}

/// Null for an arm that is not open or not plugged in.
StubArm* arm_of(char id) {
  if (id < 0 || id >= stub.count) return nullptr;
  StubArm& arm = stub.arms[static_cast<int>(id)];
  if (arm.crashes.exchange(false)) std::abort();
  while (arm.hangs) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return arm.open && arm.plugged ? &arm : nullptr;
}

int give(const std::atomic<double>* from, double* x, double* y, double* z) {
  *x = from[0], *y = from[1], *z = from[2];
  return 0;
}

}  // namespace

#define STUB extern "C" __attribute__((visibility("default")))

STUB int dhdGetDeviceCount() {
  return stub.count;
}

STUB const char* dhdErrorGetLastStr() {
  return last_error;
}

STUB int dhdOpenID(char id) {
  if (id < 0 || id >= stub.count) return refuse("no device found");
  StubArm& arm = stub.arms[static_cast<int>(id)];
  if (!arm.plugged) return refuse("communication error");
  if (arm.open) return refuse("device already in use");
  arm.open = true;
  ++arm.opened;
  return id;
}

STUB int dhdClose(char id) {
  StubArm& arm = stub.arms[static_cast<int>(id)];
  arm.open = arm.enabled = false;
  return 0;
}

STUB const char* dhdGetSystemName(char) {
  return "sigma.7";
}

STUB int dhdGetSerialNumber(unsigned short* serial, char id) {
  const StubArm* const arm = arm_of(id);
  if (arm == nullptr) return refuse("communication error");
  *serial = static_cast<unsigned short>(arm->serial);
  return 0;
}

STUB int dhdGetStatus(int* status, char id) {
  const StubArm* const arm = arm_of(id);
  if (arm == nullptr) return refuse("communication error");
  for (int k = 0; k < 16; ++k) status[k] = 0;
  status[0] = arm->power;
  status[1] = 1;
  status[2] = 1;
  status[3] = arm->reset;
  status[5] = arm->enabled && arm->power && !arm->button_off;
  status[9] = arm->error;
  return 0;
}

STUB bool dhdHasWrist(char id) {
  return arm_of(id) != nullptr && arm_of(id)->wrist;
}

STUB bool dhdHasActiveWrist(char id) {
  return arm_of(id) != nullptr && arm_of(id)->active;
}

STUB unsigned dhdGetButtonMask(char id) {
  return arm_of(id) == nullptr ? 0U : arm_of(id)->buttons.load();
}

STUB int dhdGetPosition(double* x, double* y, double* z, char id) {
  const StubArm* const arm = arm_of(id);
  return arm == nullptr ? refuse("communication error") : give(arm->position, x, y, z);
}

STUB int dhdGetLinearVelocity(double* x, double* y, double* z, char id) {
  const StubArm* const arm = arm_of(id);
  return arm == nullptr ? refuse("communication error") : give(arm->velocity, x, y, z);
}

STUB int dhdGetOrientationFrame(double frame[3][3], char id) {
  const StubArm* const arm = arm_of(id);
  if (arm == nullptr) return refuse("communication error");
  for (int k = 0; k < 9; ++k) frame[k / 3][k % 3] = arm->frame[k];
  return 1;  // DHD_TIMEGUARD
}

STUB int dhdEnableForce(unsigned char on, char id) {
  StubArm* const arm = arm_of(id);
  if (arm == nullptr) return refuse("communication error");
  arm->enabled = on != 0;
  return 0;
}

STUB int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz, double,
                                             char id) {
  StubArm* const arm = arm_of(id);
  if (arm == nullptr) return refuse("communication error");
  const double values[6] = {fx, fy, fz, tx, ty, tz};
  for (int k = 0; k < 3; ++k) {
    arm->force[k] = arm->enabled ? values[k] : 0;
    arm->torque[k] = arm->enabled ? values[3 + k] : 0;
  }
  arm->commanded = riffler::test::stub_now();
  ++arm->commands;
  return 2;  // DHD_MOTOR_SATURATED
}

STUB int dhdSetWatchdog(unsigned char eighths, char id) {
  StubArm* const arm = arm_of(id);
  if (arm == nullptr) return refuse("communication error");
  arm->watchdog = eighths;
  return 0;
}
