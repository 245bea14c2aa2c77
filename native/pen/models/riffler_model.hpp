// Riffler's own pen: device/protocol on the wire, and the kinematics of the geometry that the pen names.
#pragma once

#include <atomic>
#include <memory>

#include "device/protocol/pen_protocol.h"
#include "pen/arms/count_speed.hpp"
#include "pen/arms/joint_losses.hpp"
#include "pen/hid_model.hpp"
#include "riffler/pen/arms/compensation.hpp"
#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

class RifflerModel final : public HidModel {
 public:
  /// Reads the pen's identity. Throws OpenError for a device that is no Riffler pen, another protocol version, a
  /// different descriptor, impossible limits, or an unknown geometry. Throws std::invalid_argument for invalid shares.
  /// The geometry is the file GEOMETRY-SERIAL of the user's own pens if there is one, else the one that the pen names.
  explicit RifflerModel(HidTransport& transport, const CompensationShares& share = {});

  const DeviceCapability& capability() const noexcept override { return capability_; }
  double period() const noexcept override { return 1e-6 * limits_.period_us; }
  haptics::PassivitySettings passivity() const override;
  std::string about() const override;
  const PenGeometry* geometry() const noexcept override { return &geometry_; }
  void check(HidTransport& transport) override;
  /// Counters start at the posture at power-on: the user must hold the pen in its home posture and confirm it.
  bool home() noexcept override;

  void begin(double now) noexcept override;
  Taken take(std::span<const std::uint8_t> bytes, double now) noexcept override;
  PenSample sample(double) noexcept override { return sample_; }
  /// After a disabling report, the pen pushes only once enabled again. Reports therefore enable as long as the gate is
  /// open, so that a tool that leaves the material does not pass the firmware's ramp at the next contact, and never in
  /// a state in which the pen would not accept it. Compensation of weight and friction is scaled by the gate's gain, so
  /// it too passes the checks and the ramp. PenSample::applied excludes it, since it is not part of the wrench.
  std::size_t push(const haptics::SafeWrench& safe, double now, std::span<std::uint8_t> bytes) noexcept override;
  std::size_t release(double now, std::span<std::uint8_t> bytes) noexcept override;

 private:
  void take_report(const riffler_pen_input& report, double now, Taken& taken) noexcept;
  void place(const riffler_pen_input& report, double now) noexcept;
  bool may_enable() const noexcept;
  MotorTorques applied_wrench(const riffler_pen_input& report) const noexcept;
  std::size_t send(riffler_pen_output report, double now, std::span<std::uint8_t> bytes) noexcept;

  riffler_pen_identity identity_{};
  riffler_pen_limits limits_{};
  PenGeometry geometry_;
  Compensation share_;
  DeviceCapability capability_;
  PenKinematics kinematics_;
  CountSpeed speed_;
  JointLosses losses_;
  PenPosture posture_{};
  PenSample sample_{};
  riffler_pen_input last_{};
  bool heard_ = false;  // a report was received since opening
  bool ever_heard_ = false;
  double last_time_ = 0;    // s on the driver's clock: arrival of last_
  double device_time_ = 0;  // s on the pen's clock since the first report; does not wrap
  std::uint16_t sent_ = 0;
  /// The last commands, and their part that is no wrench; the pen reports which one it applies.
  struct Command {
    std::array<std::int16_t, kPenChannels> all{};  // mA
    MotorTorques own{};
    std::uint16_t sequence = 0;
  };
  std::array<Command, 64> commands_{};
  std::atomic<bool> home_asked_{false};
};

}  // namespace riffler::pen
