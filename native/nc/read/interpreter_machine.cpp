// Machine positions (G28, G30, G53) and knowledge of work offsets: decides which motions lie in the part.
#include <algorithm>
#include <array>
#include <stdexcept>

#include "nc/limits.hpp"
#include "nc/read/interpreter.hpp"

namespace riffler::nc {

namespace {

constexpr std::array<const char*, 9> kOffsetOptions{"g54", "g55",   "g56",   "g57",  "g58",
                                                    "g59", "g59_1", "g59_2", "g59_3"};
constexpr std::array<const char*, 9> kOffsetCodes{"G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"};

}  // namespace

/// Work offsets and the positions of G28 and G30 as options, which override those of a parameter file.
void NcInterpreter::take_positions(OptionReader& options) {
  const auto take = [&](const char* name, int first) {
    if (const auto numbers = options.numbers(name, 3, 6)) given_.positions.emplace_back(first, *numbers);
  };
  for (std::size_t k = 0; k < kOffsetOptions.size(); ++k)
    take(kOffsetOptions[k], parameter::origin(static_cast<int>(k) + 1));
  take("g28", parameter::kHome);
  take("g30", parameter::kSecondHome);
  for (const auto& [first, numbers] : given_.positions)
    for (std::size_t k = 0; k < numbers.size(); ++k)
      if (!(std::abs(numbers[k]) <= (k < 3 ? kMaxLength : kMaxAngle)))
        throw std::invalid_argument("options g54 to g59_3, g28 and g30: a number is out of range");
}

void NcInterpreter::use_positions() {
  if (!given_.parameters.empty()) {
    parameters_.load(given_.parameters);
    modes_.system = std::clamp(static_cast<int>(parameters_.stored(parameter::kSystem)), 1, 9);
    for (auto& zeros : zero_) zeros.fill(Zero::Machine);
    for (auto& known : home_known_) known.fill(true);
  }
  for (const auto& [first, numbers] : given_.positions) {
    for (std::size_t k = 0; k < numbers.size(); ++k) parameters_.set(first + static_cast<int>(k), numbers[k]);
    for (int system = 1; system <= 9; ++system)
      if (first == parameter::origin(system)) zero_[static_cast<std::size_t>(system)].fill(Zero::Machine);
    if (first == parameter::kHome) home_known_[0].fill(true);
    if (first == parameter::kSecondHome) home_known_[1].fill(true);
  }
}

/// Moves through the position in the words to that of the machine; without words all axes go there directly.
void NcInterpreter::go_home(int code) {
  const std::size_t which = code == 280 ? 0 : 1;
  refuse_in_compensation(which == 0 ? "G28" : "G30");
  const int first = which == 0 ? parameter::kHome : parameter::kSecondHome;
  const bool some = words_->has_axes();
  if (some) {
    const auto before = stand_;
    // Nearly always G91 with zeros, from the current position: not a meaningful start of a program.
    if (const Joints by = target(); rows_->begun() || by != at_ || stand_ != before) line_to(by, true);
  }
  Joints machine = frame_.to_machine(at_);
  for (const char letter : rows_->machine().axes()) {
    const std::size_t k = joint_index(letter);
    if (some && !words_->has(letter)) continue;
    const bool known = home_in_part_[which][k] || (home_known_[which][k] && is_zero_known(k));
    to_machine_position(k, machine, parameters_.stored(first + static_cast<int>(k)), known);
  }
  leave_part(which == 0 ? "G28" : "G30");
  line_to(frame_.to_program(machine), true);
}

/// The target under G53.
Joints NcInterpreter::machine_target() {
  refuse_in_compensation("G53");
  Joints machine = frame_.to_machine(at_);
  for (const char letter : rows_->machine().axes()) {
    const std::size_t k = joint_index(letter);
    if (words_->has(letter)) to_machine_position(k, machine, length_or_angle(k), is_zero_known(k));
  }
  leave_part("G53");
  return frame_.to_program(machine);
}

/// Whether the machine coordinates of an axis are known in the active system.
bool NcInterpreter::is_zero_known(std::size_t joint) const {
  return joint >= 3 || zero_[static_cast<std::size_t>(modes_.system)][joint] == Zero::Machine;
}

/// A rotary axis's machine zero is taken as the part's; that of a linear axis may be anywhere.
void NcInterpreter::to_machine_position(std::size_t joint, Joints& machine, double position, bool known) {
  stand_[joint] = known || joint >= 3 ? Stand::Given : Stand::Machine;
  if (stand_[joint] == Stand::Given) machine[joint] = position;
  if (joint >= 3 && given_.parameters.empty() && given_.positions.empty() && !rotary_noted_) {
    note("machine position", "rotary axes stand at the machine's zero where the part's is: options g54 and g28");
    rotary_noted_ = true;
  }
}

void NcInterpreter::leave_part(const char* code) {
  // X and Y of a rotated system are known only together.
  if (frame_.rotation != 0 && (stand_[0] == Stand::Machine || stand_[1] == Stand::Machine))
    stand_[0] = stand_[1] = Stand::Machine;
  if (axes_away().empty() || position_noted_) return;
  note("machine position", std::string(code) +
                               " goes to a machine position: the moves from there to the next positions in the part "
                               "are neither cut nor compared; options g28, g30 and g54 (or parameters) give it");
  position_noted_ = true;
}

/// The axes at a machine position.
std::string NcInterpreter::axes_away() const {
  std::string out;
  for (std::size_t k = 0; k < 3; ++k)
    if (stand_[k] == Stand::Machine) out += kJointLetters[k];
  return out;
}

void NcInterpreter::check_stands_in_part(const char* what) const {
  if (const std::string axes = axes_away(); !axes.empty())
    place_.fail(std::string(what) + " where " + axes +
                (axes.size() == 1 ? " stands at a machine position" : " stand at machine positions") +
                ": move there by absolute words first, or give options g28, g30 and g54");
}

/// Called before every motion: whether it ends in the part. Notes the assumptions.
bool NcInterpreter::moves_in_part(bool rapid) {
  if (!units_said_) {
    if (!given_.units) note("units", "neither G20 nor G21 before the first move: taken as millimetres; option units");
    units_said_ = true;
  }
  if (!begun_) begin_or_wait(rapid);
  const bool away = stand_[0] == Stand::Machine || stand_[1] == Stand::Machine || stand_[2] == Stand::Machine;
  if (!away) check_work_offset();
  if (rapid) return !away;
  if (away && !away_noted_) {
    note("coordinates", "a feed move where " + axes_away() + " is at a machine position: neither cut nor checked");
    away_noted_ = true;
  }
  if (!start_noted_) note_start();
  return !away;
}

/// Rapids before every linear axis has been programmed have an unknown end; a feed move takes the missing axes as 0.
void NcInterpreter::begin_or_wait(bool rapid) {
  constexpr std::size_t kMax = 1000;  // rows; a program that keeps moving without Z assumes 0
  const bool named = std::find(stand_.begin(), stand_.begin() + 3, Stand::Start) == stand_.begin() + 3;
  begun_ = named || !rapid || rows_->held() > kMax;
  if (begun_)
    rows_->release(!named);
  else
    rows_->hold();
}

/// Called at the first feed move.
void NcInterpreter::note_start() {
  start_noted_ = true;
  std::string axes;
  for (std::size_t k = 0; k < 3; ++k)
    if (stand_[k] == Stand::Start) axes += (axes.empty() ? "" : ", ") + std::string(1, kJointLetters[k]);
  if (!axes.empty())
    note("start", axes + " was not programmed before the first feed move: assumed to be 0 at the start of the program");
}

/// Many controls move each axis at its own rate.
void NcInterpreter::note_rapid(const Joints& to) {
  int linear = 0;
  for (std::size_t k = 0; k < 3; ++k) linear += to[k] != at_[k];
  if (linear < 2 || !rows_->begun() || rows_->machine().control().rapids != "unknown") return;
  note("rapid", "rapids of several axes are taken as straight lines: option rapids (straight or independent)");
  rapid_noted_ = true;
}

/// The distance between two systems is known if both are known on the machine, or from G10 L20.
void NcInterpreter::check_work_offset() {
  const auto now = static_cast<std::size_t>(modes_.system);
  if (now == first_system_) return;
  if (first_system_ == 0) {
    first_system_ = now;
    for (Zero& zero : zero_[now]) zero = std::max(zero, Zero::Relative);
    return;
  }
  const auto& first = zero_[first_system_];
  const bool known = zero_[now] == first && std::ranges::find(first, Zero::Unknown) == first.end();
  if (known || offset_noted_[now]) return;
  offset_noted_[now] = true;
  note("work offset", std::string(kOffsetCodes[now - 1]) + ": how far it is from " + kOffsetCodes[first_system_ - 1] +
                          " is not in the program, assumed to be what G10 left, or 0: options " +
                          kOffsetOptions[first_system_ - 1] + " and " + kOffsetOptions[now - 1] + ", or parameters");
}

/// What G10 tells about an axis's zero: L2 in machine coordinates, L20 relative to the tool's position.
void NcInterpreter::learn_zero(int number, std::size_t joint, bool by_position) {
  const auto system = static_cast<std::size_t>(number), now = static_cast<std::size_t>(modes_.system);
  Zero& zero = zero_[system][joint];
  if (by_position) {
    const bool lost = stand_[joint] == Stand::Machine && rows_->begun();
    zero = lost ? Zero::Unknown : std::max(zero_[now][joint], Zero::Relative);
    if (lost) note("coordinates", "G10 L20 where " + axes_away() + " is at a machine position");
    if (system == now) stand_[joint] = Stand::Given;
    return;
  }
  if (system == now && rows_->begun() && zero != Zero::Machine && !offset_noted_[now]) {
    note("work offset", std::string("G10 L2 moves the system in use, whose offset before is taken as 0: option ") +
                            kOffsetOptions[now - 1]);
    offset_noted_[now] = true;
  }
  zero = Zero::Machine;
}

}  // namespace riffler::nc
