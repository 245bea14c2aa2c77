#include "pen/simulated/simulated_pen.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "pen/arms/pens.hpp"

namespace riffler::pen {

namespace {

constexpr std::int64_t kHardwareWatchdog = 10'000;  // µs
constexpr std::int16_t kRoom = 250;                 // tenths of °C

/// Counts since power-on, in a register that wraps.
std::int32_t since(std::int32_t now, std::int32_t start) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(now) - static_cast<std::uint32_t>(start));
}

}  // namespace

SimulatedPenSettings::SimulatedPenSettings() : geometry(load_pen("riffler")) {
  riffler_pen_reference_config(&config);
}

void SimulatedPenSettings::validate() const {
  if (const char* const problem = riffler_pen_config_problem(&config))
    throw std::invalid_argument(std::string("config: ") + problem);
  hand.validate();
  cable.validate();
  if (turn_us < 25 || turn_us > SimulatedPen::kFrame || SimulatedPen::kFrame % turn_us != 0)
    throw std::invalid_argument("turn_us must divide 1000 and be at least 25");
  if (parts < 1 || parts > 100) throw std::invalid_argument("parts must be within 1 and 100");
}

SimulatedPen::SimulatedPen(const SimulatedPenSettings& settings, HandPath path)
    : settings_((settings.validate(), settings)),
      arms_(settings.geometry),
      hand_(settings.hand, std::move(path), arms_.posture().pose),
      cable_(settings.cable) {
  power_on();
}

bool SimulatedPen::pushes() const {
  return drive_.power != 0 && std::any_of(drive_.current_ma, drive_.current_ma + RIFFLER_PEN_JOINTS,
                                          [](std::int16_t current) { return current != 0; });
}

void SimulatedPen::power_on() {
  at_start_ = arms_.kinematics().counts(arms_.posture().angles);
  probe_at_start_ = arms_.kinematics().probe_count(hand_.wish().spin);
  drive_ = {};
  fed_us_ = time_us_;
  const riffler_pen_board interface = board();
  riffler_pen_loop_start(&loop_, &settings_.config, &interface);
}

void SimulatedPen::restart() {
  cable_.clear();
  halted_until_us_ = 0;
  power_on();
}

void SimulatedPen::unplug() {
  plugged_ = false;
  cable_.clear();
}

void SimulatedPen::plug() {
  cable_.clear();
  plugged_ = true;
}

riffler_pen_board SimulatedPen::board() {
  static constexpr auto kPen = [](void* context) -> SimulatedPen& { return *static_cast<SimulatedPen*>(context); };
  riffler_pen_board out{};
  out.context = this;
  out.clock_us = [](void* context) { return static_cast<std::uint32_t>(kPen(context).time_us_); };
  out.receive = [](void* context, std::uint8_t* bytes, std::size_t capacity) {
    return kPen(context).cable_.receive({bytes, capacity});
  };
  out.sense = [](void* context, riffler_pen_sensors* sensors) {
    const SimulatedPen& pen = kPen(context);
    pen.sense(*sensors);
    if (pen.on_sense) pen.on_sense(*sensors);
  };
  out.drive = [](void* context, const riffler_pen_drive* drive) { kPen(context).drive_ = *drive; };
  out.send = [](void* context, const std::uint8_t* bytes, std::size_t size) {
    SimulatedPen& pen = kPen(context);
    if (pen.plugged_) pen.cable_.offer({bytes, size});
  };
  out.feed = [](void* context) { kPen(context).fed_us_ = kPen(context).time_us_; };
  return out;
}

void SimulatedPen::sense(riffler_pen_sensors& sensors) const {
  sensors = {};
  sensors.ready = 1;
  const EncoderCounts counts = arms_.kinematics().counts(arms_.posture().angles);
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    sensors.counters[k] = since(counts[k], at_start_[k]);
    sensors.current_ma[k] = drive_.power ? drive_.current_ma[k] : std::int16_t{0};
    sensors.temperature_dc[k] = kRoom;
  }
  sensors.probe = since(arms_.kinematics().probe_count(hand_.wish().spin), probe_at_start_);
  sensors.buttons = static_cast<std::uint16_t>(hand_.wish().buttons);
}

/// Moves arms and hand for one turn of the firmware.
void SimulatedPen::move() {
  const double part = 1e-6 * static_cast<double>(settings_.turn_us) / settings_.parts;
  PenLoad load;
  for (std::size_t k = 0; k < kPenChannels; ++k)
    if (drive_.power) load.motors[k] = 1e-3 * drive_.current_ma[k] * settings_.geometry.channels[k].torque_constant;
  load.brake = drive_.brake != 0;
  for (int k = 0; k < settings_.parts; ++k) {
    PenLoad now = load;
    now.wrench = extra + weight_.pull(arms_.kinematics(), arms_.posture(), arms_.speed(), part);
    hand_.hold(arms_, 1e-6 * static_cast<double>(time_us_) + k * part, part, now);
    arms_.step(now, part);
  }
}

void SimulatedPen::turn() {
  if (time_us_ >= halted_until_us_)
    riffler_pen_loop_turn(&loop_);
  else if (time_us_ - fed_us_ > kHardwareWatchdog)
    drive_ = {};
  if (on_turn) on_turn();
}

void SimulatedPen::advance(std::int64_t until_us) {
  while (time_us_ + settings_.turn_us <= until_us) {
    move();
    time_us_ += settings_.turn_us;
    turn();
    if (plugged_ && time_us_ % kFrame == 0) cable_.frame(time_us_);
  }
}

}  // namespace riffler::pen
