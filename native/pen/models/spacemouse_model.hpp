// 3Dconnexion pucks: six deflections, no force. Old models report translation and rotation separately, new ones
// together.
#pragma once

#include "pen/hid/hid_descriptor.hpp"
#include "pen/hid_model.hpp"
#include "riffler/pen/hid/hid_list.hpp"
#include "riffler/pen/models/rate_control.hpp"

namespace riffler::pen {

/// Product name for the vendor's number; null if it is not a puck.
const char* spacemouse_name(std::uint16_t vendor, std::uint16_t product) noexcept;

/// Report 1: translation x y z, 16 bits each, and rotation x y z too if the descriptor gives it twelve bytes. Report 2:
/// rotation. Report 3: buttons, one bit each. Little-endian, ±350 at full deflection. Other reports are ignored (23 is
/// the battery). The puck's axes are right, towards the hand, down; Riffler's device axes are right, away, up: half a
/// turn about x, for rotations and translations alike.
class SpaceMouseModel final : public HidModel {
 public:
  /// Throws OpenError unless the descriptor is that of a multi-axis controller: some receivers have other collections
  /// on separate interfaces.
  SpaceMouseModel(HidTransport& transport, const HidInfo& info, const RateSettings& settings = {});

  const DeviceCapability& capability() const noexcept override { return capability_; }
  /// An untouched puck is silent.
  double period() const noexcept override { return 0; }
  std::string about() const override;
  /// Checks the descriptor.
  void check(HidTransport& transport) override;

  void begin(double now) noexcept override;
  Taken take(std::span<const std::uint8_t> bytes, double now) noexcept override;
  PenSample sample(double now) noexcept override;
  std::size_t push(const haptics::SafeWrench&, double, std::span<std::uint8_t>) noexcept override { return 0; }
  std::size_t release(double, std::span<std::uint8_t>) noexcept override { return 0; }

 private:
  /// Size in bytes of the report at the start of `bytes`, 0 if it is none.
  std::size_t take_one(std::span<const std::uint8_t> bytes, double now, Taken& taken) noexcept;
  void moved(double now, Taken& taken) noexcept;

  DeviceCapability capability_;
  RateControl control_;
  std::array<std::uint16_t, 256> sizes_{};  // sizes of input reports by number, without the number
  Vec3 translation_{0}, rotation_{0};       // fractions of full deflection
  PenSample sample_{};
};

}  // namespace riffler::pen
