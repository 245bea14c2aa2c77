// A complete pen without hardware: the reference firmware on a board with the motors and encoders of simulated arms, a
// hand that holds the grip, and a cable. Time advances only on request; the same calls give the same bytes.
#pragma once

#include <cstdint>
#include <functional>

#include "device/firmware/pen_board.h"
#include "pen/simulated/simulated_cable.hpp"
#include "pen/simulated/simulated_hand.hpp"
#include "pen/simulated/simulated_weight.hpp"

namespace riffler::pen {

struct SimulatedPenSettings {
  PenGeometry geometry;         ///< the real pen; the firmware knows only its name
  riffler_pen_config config{};  ///< of the firmware
  HandSettings hand{};
  CableSettings cable{};
  std::int64_t turn_us = 250;  ///< µs per turn of the firmware's loop; divides a millisecond
  int parts = 2;               ///< dynamics steps per turn

  /// The shipped pen with the reference firmware.
  SimulatedPenSettings();
  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

class SimulatedPen {
 public:
  /// Starts powered, plugged in and in its home posture. With an empty path, the hand holds it there.
  explicit SimulatedPen(const SimulatedPenSettings& settings, HandPath path = nullptr);
  SimulatedPen(const SimulatedPen&) = delete;
  SimulatedPen& operator=(const SimulatedPen&) = delete;

  std::int64_t time_us() const { return time_us_; }
  /// Executes all turns up to that time; none if it has passed.
  void advance(std::int64_t until_us);
  std::int64_t next_frame_us() const { return (time_us_ / kFrame + 1) * kFrame; }
  static constexpr std::int64_t kFrame = 1000;

  PenDynamics& arms() { return arms_; }
  const PenDynamics& arms() const { return arms_; }
  SimulatedHand& hand() { return hand_; }
  SimulatedWeight& weight() { return weight_; }
  SimulatedCable& cable() { return cable_; }
  const riffler_pen_firmware& firmware() const { return loop_.pen; }
  const riffler_pen_config& config() const { return settings_.config; }
  /// The state that the motors really apply; differs from the command if the board switched them off.
  const riffler_pen_drive& drive() const { return drive_; }
  bool pushes() const;

  // Faults.
  bool plugged() const { return plugged_; }
  void unplug();
  void plug();
  /// Switches power off and on: firmware and counters restart at the current posture.
  void restart();
  /// Stops the processor for `time_us`. The board's own watchdog switches the motors off after 10 ms.
  void halt(std::int64_t time_us) { halted_until_us_ = time_us_ + time_us; }
  /// Called with the sensor readings of each turn, to falsify them.
  std::function<void(riffler_pen_sensors&)> on_sense;
  /// Called after each turn of the firmware.
  std::function<void()> on_turn;
  /// A wrench on the grip in addition to hand and motors.
  Wrench extra{};

 private:
  void power_on();
  riffler_pen_board board();
  void sense(riffler_pen_sensors& sensors) const;
  void move();
  void turn();

  SimulatedPenSettings settings_;
  PenDynamics arms_;
  SimulatedHand hand_;
  SimulatedWeight weight_;
  SimulatedCable cable_;
  riffler_pen_loop loop_{};
  riffler_pen_drive drive_{};
  EncoderCounts at_start_{};  // counts at power-on
  std::int32_t probe_at_start_ = 0;
  std::int64_t time_us_ = 0, halted_until_us_ = 0, fed_us_ = 0;
  bool plugged_ = true;
};

}  // namespace riffler::pen
