// An arm behind a maker's library.
#pragma once

#include "pen/grip_turn.hpp"
#include "pen/library/arm_state.hpp"
#include "pen/pen_model.hpp"

namespace riffler::pen {

class ArmModel final : public PenModel {
 public:
  explicit ArmModel(const ArmTraits& traits);

  const DeviceCapability& capability() const noexcept override { return capability_; }
  double period() const noexcept override { return 1e-3; }
  std::string about() const override { return traits_.about; }
  MessageSizes sizes() const noexcept override { return {sizeof(ArmState), sizeof(ArmCommand)}; }

  void begin(double now) noexcept override;
  /// A reading that is not finite, or whose frame is not a rotation, is malformed.
  Taken take(std::span<const std::uint8_t> bytes, double now) noexcept override;
  PenSample sample(double) noexcept override { return sample_; }
  /// Force and torque are each reduced to the arm's limit in their own direction. Nothing before the arm is calibrated
  /// and ready.
  std::size_t push(const haptics::SafeWrench& safe, double now, std::span<std::uint8_t> bytes) noexcept override;
  std::size_t release(double now, std::span<std::uint8_t> bytes) noexcept override;

 private:
  bool turns() const noexcept;

  ArmTraits traits_;
  DeviceCapability capability_;
  PenSample sample_{};
  GripTurn turn_;
};

}  // namespace riffler::pen
