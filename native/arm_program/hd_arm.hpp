// 3D Systems' OpenHaptics: the documented functions of libHD that Riffler calls, and an arm that it drives.
//
// Names, signatures and constants are those of the maker's published headers HD/hdDevice.h, hdScheduler.h and
// hdDefines.h (OpenHaptics 3.0 to 3.5, https://support.3dsystems.com). The library is proprietary: Riffler does not
// ship it, and loads it only if the user gives its path or opens such a device. Its axes are x right, y up, z towards
// the user; lengths in mm.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "arm_program/library_arm.hpp"
#include "arm_program/shared_library.hpp"
#include "pen/library/arm_channel.hpp"
#include "riffler/pen/published.hpp"

namespace riffler::arm_program {

/// HDErrorInfo.
struct HdError {
  unsigned code;
  int internal;
  unsigned device;
};

/// The functions of libHD.
struct HdFunctions {
  using Callback = unsigned (*)(void* data);
  unsigned (*init_device)(const char* name);
  void (*disable_device)(unsigned device);
  void (*begin_frame)(unsigned device);
  void (*end_frame)(unsigned device);
  void (*make_current)(unsigned device);
  HdError (*get_error)();
  const char* (*get_error_string)(unsigned code);
  void (*enable)(unsigned capability);
  void (*disable)(unsigned capability);
  unsigned char (*is_enabled)(unsigned capability);
  void (*get_doubles)(unsigned name, double* values);
  void (*get_integers)(unsigned name, int* values);
  const char* (*get_string)(unsigned name);
  void (*set_doubles)(unsigned name, const double* values);
  unsigned (*check_calibration)();
  void (*update_calibration)(unsigned style);
  void (*start_scheduler)();
  void (*stop_scheduler)();
  unsigned long (*schedule)(Callback callback, void* data, unsigned short priority);
  void (*unschedule)(unsigned long handle);

  explicit HdFunctions(const SharedLibrary& library);
};

/// An open arm; a process can have only one, because the library has one scheduler. The library's own thread (1 kHz)
/// reads the arm and sends it the newest command, or zero force if that is older than kHeld. The program's loop only
/// exchanges values with that thread, without locks.
class HdArm final : public LibraryArm {
 public:
  static constexpr double kHeld = pen::ArmChannel::kHeld;

  /// Opens the arm with that name in the maker's configuration; empty: the default one. Throws OpenError with the
  /// library's error text.
  HdArm(std::shared_ptr<const HdFunctions> functions, const std::string& name);
  HdArm(const HdArm&) = delete;
  HdArm& operator=(const HdArm&) = delete;
  ~HdArm() override;

  const pen::ArmTraits& traits() const override { return traits_; }
  /// Also starts the library's thread.
  void enable() override;
  double due() const noexcept override { return 1e-4; }  // a new reading is at most this old when it is read
  Reading read(pen::ArmState& state) noexcept override;
  bool push(const pen::ArmCommand& command) noexcept override;

 private:
  struct Taken {
    pen::ArmState state;
    std::uint64_t number = 0;
    bool gone = false;
  };
  static unsigned serve(void* arm) noexcept;
  void tick() noexcept;
  void check() noexcept;
  void throw_error(const char* what) const;

  std::shared_ptr<const HdFunctions> hd_;
  unsigned device_ = 0;
  pen::ArmTraits traits_;
  unsigned long scheduled_ = 0;
  bool enabled_ = false;
  std::uint64_t seen_ = 0;  // number of the last reading that was read
  pen::Published<pen::TimedCommand> command_;
  pen::Published<Taken> reading_;
  Taken next_;  // used by the library's thread
};

}  // namespace riffler::arm_program
