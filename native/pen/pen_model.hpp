// Model of a family of devices: translates between messages and samples or wrenches. It does not know what carries the
// messages: a USB cable, a socket or a library.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "riffler/haptics/safety.hpp"
#include "riffler/pen/capability.hpp"
#include "riffler/pen/passivity_settings.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::pen {

struct PenGeometry;

/// The result of one read.
struct Taken {
  unsigned reports = 0;    // valid reports
  unsigned malformed = 0;  // invalid reports: too short, or with an impossible field
  unsigned lost = 0;       // reports missing before these, by sequence number
  unsigned old = 0;        // duplicate or out-of-order reports, which are ignored
};

/// Bytes of the longest messages.
struct MessageSizes {
  /// A HID report of a full-speed device has at most 65 bytes; a serial line in between may deliver several at once.
  std::size_t read = 1024;
  std::size_t write = 65;
};

class PenModel {
 public:
  virtual ~PenModel() = default;

  virtual const DeviceCapability& capability() const noexcept = 0;
  /// Time between reports, s; 0 for a device that reports only while touched, whose silence means nothing.
  virtual double period() const noexcept = 0;
  /// Device data for the passivity controller.
  virtual haptics::PassivitySettings passivity() const { return passivity_settings(capability()); }
  /// The device's own limits and identity, as text for users; may be empty.
  virtual std::string about() const { return {}; }
  /// Geometry of a two-arm pen; null for other devices. Constant.
  virtual const PenGeometry* geometry() const noexcept { return nullptr; }
  /// Constant.
  virtual MessageSizes sizes() const noexcept { return {}; }

  /// Tells the device that it stands in its home posture: from the next report on the pose is valid. Any thread. False
  /// for a device that needs no homing.
  virtual bool home() noexcept { return false; }

  // In the driver's thread: these neither allocate, throw nor wait.

  /// After opening, before the first report: resets the state.
  virtual void begin(double now) noexcept = 0;
  /// Decodes the data of one read: one report, several in sequence from a slow system, or invalid data.
  virtual Taken take(std::span<const std::uint8_t> bytes, double now) noexcept = 0;
  /// The hand at `now`. Between reports, only quantities integrated from a rate change.
  virtual PenSample sample(double now) noexcept = 0;
  /// Writes the message that pushes with a wrench about the grip's pivot (pose frame) to `bytes`, which holds
  /// `sizes().write`, and returns its size. If the gate is closed, switches off motors that can be switched off. 0 for
  /// a device that takes no messages.
  virtual std::size_t push(const haptics::SafeWrench& safe, double now, std::span<std::uint8_t> bytes) noexcept = 0;
  /// Writes the message that makes the device stop pushing, in any state.
  virtual std::size_t release(double now, std::span<std::uint8_t> bytes) noexcept = 0;
};

}  // namespace riffler::pen
