// From program to machine coordinates, and the parameters involved: G10, G28, G30, G52 … G59.3, G92.
#include <algorithm>
#include <array>
#include <cmath>

#include "nc/limits.hpp"
#include "nc/read/interpreter.hpp"

namespace riffler::nc {

using namespace parameter;

NcFrame NcInterpreter::frame_of_parameters() const {
  NcFrame frame;
  frame.tip = frame_.tip;
  frame.rotation = parameters_.stored(rotation(modes_.system));
  const bool shifted = parameters_.stored(kShifted) != 0;
  for (std::size_t k = 0; k < frame.origin.size(); ++k) {
    frame.origin[k] = parameters_.stored(origin(modes_.system) + static_cast<int>(k));
    if (shifted) frame.shift[k] = parameters_.stored(kShift + static_cast<int>(k));
  }
  return frame;
}

/// Changes the frame; the machine does not move.
void NcInterpreter::use_frame(const NcFrame& frame) {
  if (frame == frame_) return;
  refuse_in_compensation("another place of the coordinates (work offset, G92, tool offset)");
  if (frame.rotation != frame_.rotation && (stand_[0] == Stand::Machine || stand_[1] == Stand::Machine))
    stand_[0] = stand_[1] = Stand::Machine;
  at_ = frame.to_program(frame_.to_machine(at_));
  frame_ = frame;
  rows_->set_frame(frame_);
  for (const double x : at_)
    if (!(std::abs(x) <= kMaxAngle)) place_.fail("offsets are out of range");
}

void NcInterpreter::select_system(int code) {
  if (code < 0) return;
  const int system = code <= 590 ? (code - 530) / 10 : 6 + code - 590;
  // Assignments to parameters of the active system count only when it is selected again, as in LinuxCNC.
  if (system == modes_.system) return;
  modes_.system = system;
  use_frame(frame_of_parameters());
}

double NcInterpreter::length_or_angle(std::size_t joint) {
  return words_->value(kJointLetters[joint], joint < 3 ? kMaxLength : kMaxAngle) * (joint < 3 ? modes_.unit : 1);
}

void NcInterpreter::non_modal() {
  switch (words_->code(NcGroup::NonModal)) {
    case 100:
      return set_data();
    case 280:
    case 300:
      return go_home(words_->code(NcGroup::NonModal));
    case 281:
    case 301: {
      check_stands_in_part("G28.1 and G30.1");
      refuse_in_compensation("G28.1 and G30.1");
      const Joints machine = frame_.to_machine(at_);
      const int first = words_->code(NcGroup::NonModal) == 281 ? kHome : kSecondHome;
      for (std::size_t k = 0; k < machine.size(); ++k) {
        parameters_.set(first + static_cast<int>(k), machine[k]);
        home_in_part_[first == kHome ? 0 : 1][k] = true;
      }
      return;
    }
    case 520:
      return shift_by_words(true);
    case 920:
      return shift_by_words(false);
    case 921:
      for (int k = 0; k < 6; ++k) parameters_.set(kShift + k, 0);
      [[fallthrough]];
    case 922:
      parameters_.set(kShifted, 0);
      return use_frame(frame_of_parameters());
    case 923:
      parameters_.set(kShifted, 1);
      return use_frame(frame_of_parameters());
    default:
      return;
  }
}

void NcInterpreter::set_data() {
  if (!words_->has('L')) place_.fail("G10 needs L");
  const int what = words_->whole('L');
  if (what == 0) return;
  if (!words_->has('P')) place_.fail("G10 needs P");
  const int number = words_->whole('P');
  if (what == 1 || what == 10 || what == 11) {
    // The tool table: lengths are the control's business, since the tip is programmed.
    words_->pass_over("XYZABCIJQ");
    if (words_->has('R')) tool_radii_[number] = words_->value('R', kMaxLength) * modes_.unit;
  } else if (what == 2 || what == 20) {
    if (number > 9) place_.fail("G10 L" + std::to_string(what) + " takes P0 to P9");
    set_system(number == 0 ? modes_.system : number, what == 20);
  } else {
    place_.fail("G10 L" + std::to_string(what) + " is not read: L1, L2, L10, L11 and L20 are");
  }
}

void NcInterpreter::set_system(int number, bool by_position) {
  if (words_->has('R')) {
    if (by_position) place_.fail("R with G10 L20: only L2 turns a system");
    parameters_.set(rotation(number), words_->value('R', kMaxAngle));
  }
  NcFrame frame = frame_;
  frame.rotation = parameters_.stored(rotation(number));
  for (std::size_t k = 0; k < 6; ++k) frame.origin[k] = parameters_.stored(origin(number) + static_cast<int>(k));
  // The tool's position in that system, with the words replacing what they name.
  const Joints machine = frame_.to_machine(at_);
  Joints wanted = frame.to_program(machine);
  for (std::size_t k = 0; k < 6; ++k) {
    if (!words_->has(kJointLetters[k])) continue;
    const double word = length_or_angle(k);
    if (by_position)
      wanted[k] = word;
    else
      frame.origin[k] = word;
    if (k < 3) learn_zero(number, k, by_position);
  }
  if (by_position) {
    const Joints now = frame.to_machine(wanted);
    for (std::size_t k = 0; k < 6; ++k)
      if (const double off = machine[k] - now[k]; off != 0) frame.origin[k] += off;
  }
  for (std::size_t k = 0; k < 6; ++k) {
    if (!(std::abs(frame.origin[k]) <= kMaxAngle)) place_.fail("offsets are out of range");
    parameters_.set(origin(number) + static_cast<int>(k), frame.origin[k]);
  }
  if (number == modes_.system) use_frame(frame);
}

/// G92: the tool's position gets the coordinates in the words. G52: the words are the shift itself.
void NcInterpreter::shift_by_words(bool local) {
  if (!words_->has_axes()) place_.fail(local ? "G52 without axis words" : "G92 without axis words");
  NcFrame frame = frame_;
  for (std::size_t k = 0; k < 6; ++k) {
    if (!words_->has(kJointLetters[k])) continue;
    if (!local && stand_[k] == Stand::Machine && rows_->begun())
      note("coordinates", "G92 where " + axes_away() + " is at a machine position: what follows may lie elsewhere");
    if (!local) stand_[k] = Stand::Given;
    frame.shift[k] = local ? length_or_angle(k) : at_[k] + frame.shift[k] - length_or_angle(k);
  }
  for (std::size_t k = 0; k < 6; ++k) {
    if (!(std::abs(frame.shift[k]) <= kMaxAngle)) place_.fail("offsets are out of range");
    parameters_.set(kShift + static_cast<int>(k), frame.shift[k]);
  }
  parameters_.set(kShifted, 1);
  use_frame(frame);
}

std::optional<double> NcInterpreter::predefined(int number) const {
  if (number == kSystem) return modes_.system;
  if (number == 5400) return tool_;
  if (number >= 5401 && number <= 5428) {
    if (number < 5420) return 0;
    const int k = number - 5420;
    if (k > 5) return 0;
    if (stand_[static_cast<std::size_t>(k)] == Stand::Machine) check_stands_in_part("a position is read");
    refuse_in_compensation("a position is read");
    return at_[static_cast<std::size_t>(k)] / (k < 3 ? modes_.unit : 1);
  }
  return std::nullopt;
}

std::optional<double> NcInterpreter::predefined(std::string_view name) const {
  const auto truth = [](bool is) { return is ? 1.0 : 0.0; };
  const Modes& m = modes_;
  if (name.size() == 2) {
    const std::size_t k = std::string_view("xyzabc").find(name[1]);
    if (k != std::string_view::npos && stand_[k] == Stand::Machine) check_stands_in_part("a position is read");
    if (k != std::string_view::npos) refuse_in_compensation("a position is read");
    if (k != std::string_view::npos) return at_[k] / (k < 3 ? m.unit : 1);
    return name[1] >= 'u' && name[1] <= 'w' ? std::optional(0.0) : std::nullopt;
  }
  if (name == "_motion_mode") return motion_ < 0 || cancelled_ ? 800 : motion_;
  if (name == "_plane") return m.plane[2] == 2 ? 170 : m.plane[2] == 1 ? 180 : 190;
  if (name == "_coord_system") return m.system <= 6 ? 530 + 10 * m.system : 584 + m.system;
  if (name == "_metric") return truth(m.unit == 1);
  if (name == "_imperial") return truth(m.unit != 1);
  if (name == "_absolute") return truth(m.absolute);
  if (name == "_incremental") return truth(!m.absolute);
  if (name == "_ijk_absolute_mode") return truth(m.absolute_centre);
  if (name == "_inverse_time") return truth(m.feed_mode == 930);
  if (name == "_units_per_minute") return truth(m.feed_mode == 940);
  if (name == "_units_per_rev") return truth(m.feed_mode == 950);
  if (name == "_retract_r_plane") return truth(m.return_level == 990);
  if (name == "_retract_old_z") return truth(m.return_level == 980);
  if (name == "_spindle_css_mode") return truth(m.surface_speed);
  if (name == "_spindle_rpm_mode") return truth(!m.surface_speed);
  if (name == "_spindle_on") return truth(m.turning != 0);
  if (name == "_spindle_cw") return truth(m.turning > 0);
  if (name == "_ccomp") return compensation_code_;
  if (name == "_cutter_comp" || name == "_remap_level" || name == "_lathe_diameter_mode" || name == "_task") return 0;
  if (name == "_lathe_radius_mode") return 1;
  if (name == "_feed") return m.feed / (m.feed_mode == 930 ? 1 : m.unit);
  if (name == "_rpm") return m.speed;
  if (name == "_current_tool") return tool_;
  if (name == "_selected_tool") return next_tool_;
  if (name == "_tool_offset") return truth(length_used_);
  if (name == "_line") return place_.line;
  if (name == "_vmajor") return 2.9;
  if (name == "_vminor") return 0;
  return std::nullopt;
}

}  // namespace riffler::nc
