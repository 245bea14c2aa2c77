// The open-hardware stylus of WoodenHaptics and Polhem: an arm with three motorised joints, and three encoders in the
// wrist.
//
// The facts come from the makers' published source (github.com/forsslund/haptikfabrikenapi, of 2020): the 16-bit fields
// of both messages (fsusbhapticdevicethread.h, firmware/main.cpp), the button hidden in an encoder value, the
// firmware's answer to every message, and the dimensions (haptikfabrikenapi.h). No code was taken. That code continues
// with zeroed encoders after a read error and clamps each motor separately, which changes the direction of the force;
// neither happens here.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "pen/hid_model.hpp"
#include "riffler/pen/hid/hid_list.hpp"

namespace riffler::pen {

/// Three joints in series: A turns the arm about the vertical axis, B the upper arm and C the fore arm, both measured
/// from vertical and each driven by its own motor on the base, so that C does not turn with B.
struct PolhemGeometry {
  const char* name;
  std::array<double, 3> ratio;            // turns of the motor per turn of the joint
  std::array<int, 3> sign;                // sign of the joint for growing counts
  double base, upper, fore;               // mm: height of the shoulder, lengths
  Vec3 origin;                            // mm: subtracted from positions
  std::array<double, 3> torque_constant;  // N·mm/A at the motor
  double counts;                          // per turn of the motor
  double peak_current;                    // A
  std::array<std::int16_t, 6> preset;     // counts in the home posture
};

/// "woodenhaptics" or "polhem-1"; null for others. The linkage of the second and third Polhem is not published.
const PolhemGeometry* polhem_geometry(std::string_view name) noexcept;

struct PolhemPosture {
  Vec3 tip{0};       // mm
  Mat3 jacobian{1};  // mm per rad of A, B, C
};
PolhemPosture polhem_posture(const PolhemGeometry& geometry, const Vec3& angles) noexcept;

class PolhemModel final : public HidModel {
 public:
  /// Throws OpenError unless the descriptor has unnumbered reports of at least 14 bytes in both directions.
  PolhemModel(HidTransport& transport, const PolhemGeometry& geometry);

  const DeviceCapability& capability() const noexcept override { return capability_; }
  double period() const noexcept override { return 1e-3; }
  std::string about() const override;
  void check(HidTransport& transport) override;
  /// Makes the firmware preset its counters.
  bool home() noexcept override;

  void begin(double now) noexcept override;
  Taken take(std::span<const std::uint8_t> bytes, double now) noexcept override;
  PenSample sample(double) noexcept override { return sample_; }
  /// Pushes the force only; there are no motors for torque.
  std::size_t push(const haptics::SafeWrench& safe, double now, std::span<std::uint8_t> bytes) noexcept override;
  std::size_t release(double now, std::span<std::uint8_t> bytes) noexcept override;

 private:
  void place(std::span<const std::uint8_t> report, double now) noexcept;
  std::array<std::int16_t, 3> currents(const Vec3& force) const noexcept;

  PolhemGeometry geometry_;
  DeviceCapability capability_;
  std::size_t input_size_ = 0, output_size_ = 0;  // bytes as read and written: an output report begins with a 0
  std::array<std::int32_t, 3> counts_{};          // the 16-bit counters unwrapped
  std::array<std::int16_t, 6> raw_{};
  Vec3 angles_{0};
  PolhemPosture posture_{};
  PenSample sample_{};
  double last_time_ = 0;
  bool heard_ = false;
  bool homing_ = false;  // the preset was sent but does not show in the counters yet
  std::atomic<bool> home_asked_{false};
};

}  // namespace riffler::pen
