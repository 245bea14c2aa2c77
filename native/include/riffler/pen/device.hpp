// The common interface of all input devices: pens with motors, pucks, recordings, tablets, mice.
#pragma once

#include <memory>
#include <string>

#include "riffler/base/thread_priority.hpp"
#include "riffler/haptics/states.hpp"
#include "riffler/pen/capability.hpp"
#include "riffler/pen/link_status.hpp"
#include "riffler/pen/passivity_settings.hpp"
#include "riffler/pen/pen_step.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::pen {

struct PenGeometry;

/// Why a requested wrench is not, or not entirely, felt.
enum class NotPushed : unsigned char {
  None,          // the whole wrench will be felt
  NoMotors,      // no motor for some or all of it: see `missing`
  NotConnected,  // the device is disconnected
  NotHomed,      // the device does not know its pose
  NotPowered,    // the device reports a fault, or is not ready
  BadWrench,     // not finite
  Tripped,       // a safety check failed: see cause()
};
/// The reason as a short text for users.
const char* not_pushed_text(NotPushed reason) noexcept;

/// The answer to a requested wrench.
struct PushAnswer {
  Wrench felt{}, missing{};  // at full gain; their sum is the requested wrench
  NotPushed reason = NotPushed::None;
};

/// An input device. The destructor stops it. Functions are for one thread unless stated otherwise.
class Pen {
 public:
  virtual ~Pen() = default;

  /// Name of the device family: "riffler-pen", "spacemouse", "recording", "tablet" …
  virtual std::string kind() const = 0;
  /// The coordinates that are sensed and pushed. Constant.
  virtual const DeviceCapability& capability() const noexcept = 0;
  /// Whether poses are those of the tool in the part frame, rather than those of a grip on a desk.
  virtual bool in_part_frame() const noexcept { return false; }
  /// Settings for the passivity controller of a step. Constant.
  virtual haptics::PassivitySettings passivity() const { return passivity_settings(capability()); }
  /// Text about the device itself, for users.
  virtual std::string about() const { return {}; }
  /// Geometry of a two-arm pen, with the currents that the device allows; null for other devices. Constant.
  virtual const PenGeometry* geometry() const noexcept { return nullptr; }

  /// The newest sample; sample.time is on the clock of `now`. Any thread; never waits.
  virtual PenSample newest() const noexcept = 0;
  /// Time on the clock of the samples, s. Any thread.
  virtual double now() const noexcept = 0;
  /// Time since the newest sample was measured, s; infinite before the first. Any thread.
  double age() const noexcept;

  /// Requests a wrench about the grip's pivot, in the pose frame, and returns which part of it the hand will feel. It
  /// holds for 20 ms, so it must be repeated. One thread only; never waits. Ignored where the device cannot push; the
  /// answer gives the reason.
  virtual PushAnswer push(const Wrench& wrench) noexcept;

  /// Installs `step`, which from then on computes the wrench in the device's own thread; push() then answers as for a
  /// device without motors. Null returns control to push(). On return, the previous step is no longer called. Call it
  /// from the thread that pushes, not from within a step; it waits for at most one call of the previous step. Returns
  /// false, and changes nothing, if the device has no thread of its own.
  virtual bool set_step(std::shared_ptr<PenStep> step) {
    static_cast<void>(step);
    return false;
  }

  /// State of the force. It ramps up from the first push() and is taken away where a check fails. reset() clears trips
  /// that do not heal by themselves. Any thread.
  virtual haptics::ForceState force_state() const noexcept { return haptics::ForceState::Off; }
  virtual haptics::Cause cause() const noexcept { return haptics::Cause::None; }
  virtual void reset() noexcept {}

  /// Tells the device that it stands in its home posture. False if nothing has to be homed.
  virtual bool home() noexcept { return false; }
  /// State of the connection. Any thread; never waits.
  virtual LinkStatus status() const noexcept;
  /// Why the device is not available, or empty.
  virtual std::string problem() const { return {}; }
  /// How the system runs the device's own thread, in which forces are computed. Never call it from that thread.
  virtual base::ThreadPriority priority() const;
  /// Stops pushing and closes the device. False if the device did not accept the stop in time.
  virtual bool stop() { return true; }
};

}  // namespace riffler::pen
