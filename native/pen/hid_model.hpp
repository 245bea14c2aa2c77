// What a family of HID devices says and understands: between the bytes of its reports and samples and wrenches. A new
// family is one file with one of these, and one line in registry.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "pen/hid/transport.hpp"
#include "riffler/haptics/safety.hpp"
#include "riffler/pen/capability.hpp"
#include "riffler/pen/hid/open_error.hpp"
#include "riffler/pen/passivity_settings.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::pen {

struct PenGeometry;

/// What one read brought.
struct Taken {
  unsigned reports = 0;    // samples that it held
  unsigned malformed = 0;  // pieces that are no report: too short, with an impossible field
  unsigned lost = 0;       // reports that the numbers say were sent before these and never came
  unsigned old = 0;        // reports that came again or in the wrong order; left out
};

class HidModel {
 public:
  virtual ~HidModel() = default;

  virtual const DeviceCapability& capability() const noexcept = 0;
  /// s between its reports; 0 for a device that only speaks while it is touched, whose silence means nothing.
  virtual double period() const noexcept = 0;
  /// What the passivity controller may count on.
  virtual haptics::PassivitySettings passivity() const { return passivity_settings(capability()); }
  /// Its own limits and identity, for people; may be empty.
  virtual std::string about() const { return {}; }
  /// Of a pen of two arms; null for everything else. Does not change.
  virtual const PenGeometry* geometry() const noexcept { return nullptr; }

  /// Whether what was just opened is this very device, in the state that the model expects. Throws OpenError. Not in
  /// the driver's thread, and never while that thread uses the model.
  virtual void check(Transport& transport) = 0;

  /// The device stands where its homing says: from the next report on the pose is sure. Any thread. False for a device
  /// that needs no homing.
  virtual bool home() noexcept { return false; }

  // In the driver's thread: these allocate nothing, throw nothing and wait for nothing.

  /// After opening, before the first report: forget what came before.
  virtual void begin(double now) noexcept = 0;
  /// What one read gave: a report, or several one after the other as a slow system may deliver them, or garbage.
  virtual Taken take(std::span<const std::uint8_t> bytes, double now) noexcept = 0;
  /// The hand at `now`. Between reports only what is integrated from a rate goes on.
  virtual PenSample sample(double now) noexcept = 0;
  /// The report that pushes with the wrench about the grip's pivot, in the frame of poses; its size. Where the gate is
  /// not open, motors that can be switched off are. 0 for a device that takes no reports. `bytes` holds 65.
  virtual std::size_t push(const haptics::SafeWrench& safe, double now, std::span<std::uint8_t> bytes) noexcept = 0;
  /// The report after which the device does not push, whatever it was told before.
  virtual std::size_t release(double now, std::span<std::uint8_t> bytes) noexcept = 0;
};

}  // namespace riffler::pen
