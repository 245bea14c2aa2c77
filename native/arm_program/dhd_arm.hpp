// Force Dimension's libdhd: the documented functions that Riffler calls, and an arm that it drives.
//
// Names, signatures and constants are those of the maker's published header dhdc.h (Haptic SDK 3.2 to 3.17,
// https://www.forcedimension.com/software/sdk). The library is proprietary: Riffler does not ship it, and loads it only
// if the user gives its path or opens such a device. Its axes are x towards the user, y right, z up; lengths in m.
#pragma once

#include <memory>
#include <string>

#include "arm_program/library_arm.hpp"
#include "arm_program/shared_library.hpp"

namespace riffler::arm_program {

/// The functions of libdhd. An ID is a char there.
struct DhdFunctions {
  int (*get_device_count)();
  int (*open_id)(char id);
  int (*close)(char id);
  const char* (*get_system_name)(char id);
  int (*get_serial_number)(unsigned short* serial, char id);
  int (*get_status)(int* status, char id);
  bool (*has_wrist)(char id);
  bool (*has_active_wrist)(char id);
  unsigned (*get_button_mask)(char id);
  int (*get_position)(double* x, double* y, double* z, char id);
  int (*get_linear_velocity)(double* x, double* y, double* z, char id);
  int (*get_orientation_frame)(double frame[3][3], char id);
  int (*enable_force)(unsigned char on, char id);
  int (*set_force)(double fx, double fy, double fz, double tx, double ty, double tz, double grip, char id);
  int (*set_watchdog)(unsigned char eighths, char id);  // multiples of 125 µs; null in old versions
  const char* (*get_last_error)();

  explicit DhdFunctions(const SharedLibrary& library);
};

class DhdArm final : public LibraryArm {
 public:
  static constexpr double kPeriod = 1e-3;    // s between two readings
  static constexpr double kWatchdog = 0.02;  // s without a command after which the arm itself ends the force

  /// Opens the arm with that number, from 0. Throws OpenError with the library's error text.
  DhdArm(std::shared_ptr<const DhdFunctions> functions, int number);
  DhdArm(const DhdArm&) = delete;
  DhdArm& operator=(const DhdArm&) = delete;
  ~DhdArm() override;

  const pen::ArmTraits& traits() const override { return traits_; }
  void enable() override;
  double due() const noexcept override;
  Reading read(pen::ArmState& state) noexcept override;
  bool push(const pen::ArmCommand& command) noexcept override;

 private:
  bool read_status() noexcept;
  [[noreturn]] void fail(const char* what) const;

  std::shared_ptr<const DhdFunctions> dhd_;
  char id_ = -1;
  pen::ArmTraits traits_;
  pen::ArmState state_;
  double next_ = 0, status_due_ = 0;  // s of the steady clock
  bool enabled_ = false;
};

}  // namespace riffler::arm_program
