// Haply's Inverse3: an arm with three motors, driven by the maker's service, and a grip that senses its orientation.
#pragma once

#include <string>

#include "pen/grip_turn.hpp"
#include "pen/haply/haply_message.hpp"
#include "pen/pen_model.hpp"

namespace riffler::pen {

class HaplyModel final : public PenModel {
 public:
  /// N along any direction. Lower than what the arm can do, which its maker does not publish as a number that holds in
  /// every posture: public programs for it stop at 5 N.
  static constexpr double kMostForce = 5;

  /// `inventory`: the first message of the service. `id`: the arm. The n-th grip belongs to the n-th arm; without one
  /// no axis is sensed. Throws OpenError as check().
  HaplyModel(const HaplyMessage& inventory, std::string_view id, const HaplyVersion& version);

  const DeviceCapability& capability() const noexcept override { return capability_; }
  double period() const noexcept override { return 1e-3; }
  std::string about() const override;
  MessageSizes sizes() const noexcept override;

  /// Checks that the arm is there and free. Throws OpenError: Unplugged, Busy, OtherVersion. Not in the driver's
  /// thread, and never while that thread uses the model.
  void check(const HaplyMessage& inventory, const HaplyVersion& version);

  void begin(double now) noexcept override;
  Taken take(std::span<const std::uint8_t> bytes, double now) noexcept override;
  PenSample sample(double) noexcept override { return sample_; }
  /// The service answers each message with a state, so every push asks for the next report. Only force: the arm has no
  /// motors for torque. No force before the arm is calibrated, powered and ready.
  std::size_t push(const haptics::SafeWrench& safe, double now, std::span<std::uint8_t> bytes) noexcept override;
  std::size_t release(double now, std::span<std::uint8_t> bytes) noexcept override;

 private:
  void place(const HaplyEntry& arm, double now) noexcept;
  void see(const HaplyEntry& arm) noexcept;

  DeviceCapability capability_;
  std::string id_, grip_, model_;
  HaplyVersion version_;
  GripTurn turn_;
  PenSample sample_{};
  bool calibrated_ = false, supplied_ = false, ready_ = false;
};

}  // namespace riffler::pen
