// One interface for everything that a hand can hold: pens with motors, pucks, recordings, tablets, mice.
#pragma once

#include <memory>
#include <string>

#include "riffler/haptics/states.hpp"
#include "riffler/pen/capability.hpp"
#include "riffler/pen/link_status.hpp"
#include "riffler/pen/passivity_settings.hpp"
#include "riffler/pen/pen_step.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::pen {

struct PenGeometry;

enum class NotPushed : unsigned char {
  None,          // all of it will be felt
  NoMotors,      // some or all of it has no motor: `missing`
  NotConnected,  // the device is gone
  NotHomed,      // it does not know where it is
  NotPowered,    // it reports a fault, or is not ready
  BadWrench,     // not finite
  Tripped,       // a check of the safety failed: cause() says which
};
const char* not_pushed_text(NotPushed reason) noexcept;

struct PushAnswer {
  Wrench felt{}, missing{};  // at full gain; their sum is what was asked for
  NotPushed reason = NotPushed::None;
};

/// Destroying one stops it. Where nothing else is said, functions are for one thread.
class Pen {
 public:
  virtual ~Pen() = default;

  /// As families are called: "riffler-pen", "spacemouse", "recording", "tablet" …
  virtual std::string kind() const = 0;
  /// Which coordinates are sensed and which can push. Does not change.
  virtual const DeviceCapability& capability() const noexcept = 0;
  /// Its poses are where the tool shall be, and not where some grip is on a desk.
  virtual bool in_part_frame() const noexcept { return false; }
  /// What the passivity controller of a step may count on. Does not change.
  virtual haptics::PassivitySettings passivity() const { return passivity_settings(capability()); }
  /// Of the device itself, for people.
  virtual std::string about() const { return {}; }
  /// Of a pen of two arms, with the currents that the device allows; null for everything else. Does not change.
  virtual const PenGeometry* geometry() const noexcept { return nullptr; }

  /// The newest sample; sample.time is in seconds of `now`. Any thread; never waits.
  virtual PenSample newest() const noexcept = 0;
  /// s of the clock that samples are dated by. Any thread.
  virtual double now() const noexcept = 0;
  /// s since the newest sample was measured; infinite before the first. Any thread.
  double age() const noexcept;

  /// Asks for a wrench about the grip's pivot, in the frame of poses, and says what of it the hand will feel. It holds
  /// for 20 ms: whoever pushes goes on asking. By one thread; never waits. Ignored, and the answer says why, where the
  /// device cannot push.
  virtual PushAnswer push(const Wrench& wrench) noexcept;

  /// From now on `step` computes the wrench, in the device's own thread, and push() is answered as by a device without
  /// motors; null gives it back to push(). When this returns, the step before is not called any more. By the thread
  /// that pushes, not from within a step; waits for one call of the step before at most. False, and nothing changed,
  /// where the device has no thread of its own.
  virtual bool set_step(std::shared_ptr<PenStep> step) {
    static_cast<void>(step);
    return false;
  }

  /// What lets push() through: it ramps up from the first call on, and is taken away where a check fails. Trips that do
  /// not heal by themselves are cleared by reset(). Any thread.
  virtual haptics::ForceState force_state() const noexcept { return haptics::ForceState::Off; }
  virtual haptics::Cause cause() const noexcept { return haptics::Cause::None; }
  virtual void reset() noexcept {}

  /// The device stands in its home posture. False where nothing has to be homed.
  virtual bool home() noexcept { return false; }
  /// Any thread; never waits.
  virtual LinkStatus status() const noexcept;
  /// Why the device is not there, or nothing.
  virtual std::string problem() const { return {}; }
  /// The device does not push any more, and is closed. False where it could not be told in time.
  virtual bool stop() { return true; }
};

}  // namespace riffler::pen
