// Blocks without motion: modes, feed and speed, tools, saved states.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nc/limits.hpp"
#include "nc/machine/machines.hpp"
#include "nc/read/interpreter.hpp"

namespace riffler::nc {

void NcInterpreter::units_and_feed_mode() {
  if (const int code = words_->code(NcGroup::Units); code >= 0) {
    modes_.unit = code == 200 || code == 700 ? kInch : 1;
    units_said_ = true;
  }
  const int mode = words_->code(NcGroup::FeedMode);
  if (mode < 0) return;
  // A feed number of one mode has no meaning in another.
  if (mode != modes_.feed_mode) modes_.feed = 0;
  modes_.feed_mode = mode;
}

void NcInterpreter::feed_and_speed() {
  if (modes_.feed_mode == 930) modes_.feed = 0;  // F applies to its own block only
  if (words_->has('F')) {
    modes_.feed = words_->value('F', kMaxFeed / kInch) * (modes_.feed_mode == 930 ? 1 : modes_.unit);
    if (modes_.feed < 0) place_.fail("F is negative");
    feed_given_ = feed_given_ || modes_.feed > 0;
  }
  if (words_->has('S')) {
    modes_.speed = words_->value('S', kMaxSpindle);
    if (modes_.speed < 0) place_.fail("S is negative");
  }
}

void NcInterpreter::spindle() {
  switch (words_->code(NcGroup::Spindle)) {
    case 30:
    case 130:  // with coolant
      modes_.turning = 1;
      break;
    case 40:
    case 140:
      modes_.turning = -1;
      break;
    case 50:
      modes_.turning = 0;
      break;
    case 190:
      words_->pass_over("RQP");
      modes_.turning = 0;
      break;
    default:
      break;
  }
  if (const int mode = words_->code(NcGroup::SpindleMode); mode == 960) {
    if (!words_->has('S')) place_.fail("G96 needs S");
    // The speed depends on the distance from a lathe's centre; D limits it.
    modes_.surface_speed = true;
    modes_.speed = words_->has('D') ? words_->value('D', kMaxSpindle) : 0;
    if (modes_.speed < 0) place_.fail("D is negative");
  } else if (mode == 970) {
    modes_.surface_speed = false;
  }
}

/// Switches and outputs: checks that their words are there; no effect.
void NcInterpreter::signals() {
  const int code = words_->code(NcGroup::Signal);
  const auto need = [&](char letter) {
    if (!words_->has(letter)) place_.fail(nc_code_name('M', code) + " needs " + letter);
  };
  if (code >= 620 && code <= 650) need('P');
  if (code == 660 && words_->has('P') == words_->has('E')) place_.fail("M66 needs P or E");
  if (code == 670 || code == 680) need('E'), need('Q');
  if (code >= 0) words_->pass_over("PELQ");
  if (words_->code(NcGroup::Override) >= 0) words_->pass_over("P");
  if (words_->code(NcGroup::User) >= 0) {
    words_->pass_over("PQ");
    note("user code",
         nc_code_name('M', words_->code(NcGroup::User)) + " is a function of the machine: taken to move nothing");
  }
}

void NcInterpreter::tool() {
  if (words_->has('T')) next_tool_ = words_->whole('T');
  const int code = words_->code(NcGroup::ToolChange);
  if (code < 0) return;
  if (code == 610 && !words_->has('Q')) place_.fail("M61 needs Q");
  refuse_in_compensation("a change of the tool");
  diameter_number_.reset();
  tool_ = code == 610 ? words_->whole('Q') : next_tool_;
  if (code == 60) modes_.turning = 0;
  length_.reset();
  if (frame_.tip != Vec3(0)) {
    NcFrame frame = frame_;
    frame.tip = Vec3(0);
    use_frame(frame);
  }
}

void NcInterpreter::states() {
  const int code = words_->code(NcGroup::State);
  const auto here =
      std::find_if(saved_.begin(), saved_.end(), [&](const Saved& s) { return s.depth == flow_->depth(); });
  if (code == 700 || code == 730) {
    const Saved state{modes_, flow_->depth(), code == 730};
    if (here != saved_.end())
      *here = state;
    else
      saved_.push_back(state);
  } else if (code == 720) {
    if (here == saved_.end()) place_.fail("M72 without M70 or M73 in the same subroutine");
    restore(here->modes);
  } else if (code == 710 && here != saved_.end()) {
    saved_.erase(here);
  }
}

/// After a return: restores what M73 saved in the subroutine, discards what M70 saved there.
void NcInterpreter::leave_saved_states() {
  while (!saved_.empty() && saved_.back().depth > flow_->depth()) {
    const Saved state = saved_.back();
    saved_.pop_back();
    if (state.restores) restore(state.modes);
  }
}

void NcInterpreter::restore(const Modes& modes) {
  if (modes.plane != modes_.plane) refuse_in_compensation("another plane");
  modes_ = modes;
  use_frame(frame_of_parameters());
}

/// LinuxCNC's switchable kinematics: M428 makes X Y Z the tip, M429 the axis positions.
void NcInterpreter::kinematics() {
  const int code = words_->code(NcGroup::Kinematics);
  if (code < 0) return;
  if (code == 4300)
    place_.fail(
        "M430 (a third kinematics of the machine's own) is not known: leave it out, or write the moves "
        "for M428 or M429");
  const bool tip_words = code == 4280;
  const Machine& machine = rows_->machine();
  if (machine.branches() == 1 || machine.joint_words() != tip_words) return;
  refuse_in_compensation("a switch of the kinematics");
  if (tcp_given_)
    place_.fail(std::string(tip_words ? "M428 makes X Y Z the tip" : "M429 makes X Y Z the axis positions") +
                ", but option tcp says otherwise: leave the option out, and what the program says is followed");
  Options options = machine_options_;
  options["tcp"] = tip_words;
  OptionReader taken(options, "machine " + machine_);
  std::unique_ptr<Machine> other = make_machine(machine_, taken);
  if (other->joint_words() == tip_words)
    place_.fail(nc_code_name('M', code) + " switches kinematics that machine " + machine_ +
                " does not have: read with the machine that the program is for");
  if (!axes_away().empty()) stand_[0] = stand_[1] = stand_[2] = Stand::Machine;
  at_ = rows_->change_machine(std::move(other), at_);
}

void NcInterpreter::dwell() {
  if (words_->code(NcGroup::NonModal) != 40) return;
  const char time = words_->has('P') ? 'P' : 'X';  // Fanuc's G04 X2. waits two seconds
  if (!words_->has(time)) place_.fail("G4 needs P");
  if (words_->value(time, 1e6) < 0) place_.fail(std::string(1, time) + " is negative");
  if (time == 'P' && words_->has_axes() && words_->code(NcGroup::Motion) < 0)
    place_.fail("axis words together with G4");
}

void NcInterpreter::modes() {
  const auto plane = modes_.plane;
  switch (words_->code(NcGroup::Plane)) {
    case 170:
      modes_.plane = {0, 1, 2};
      break;
    case 180:
      modes_.plane = {2, 0, 1};
      break;
    case 190:
      modes_.plane = {1, 2, 0};
      break;
    case -1:
      break;
    default:
      place_.fail("planes of the axes U V W (G17.1, G18.1, G19.1) are not read");
  }
  if (modes_.plane != plane) refuse_in_compensation("another plane");
  if (const int code = words_->code(NcGroup::CutterCompensation); code >= 0) compensate(code);
  if (words_->code(NcGroup::LatheRadius) == 70) place_.fail("G7 (diameters) is for lathes: write radii (G8)");
}

/// The tip is programmed, independent of the tool's length: G43, G43.2 and G43.4 state that the control knows it. The
/// first dynamic offset (G43.1) is taken as the tool's length, so that a later one moves the tip by the difference.
void NcInterpreter::tool_length() {
  const int code = words_->code(NcGroup::ToolLength);
  // H and D without a code that uses them select offsets that other blocks activate.
  if (words_->has('H')) length_number_ = words_->whole('H');
  choose_offset();
  if (code < 0) return;
  NcFrame frame = frame_;
  frame.tip = Vec3(0);
  length_off_ = code == 490 && length_used_;
  length_used_ = code != 490;
  if (code == 431) {
    if (words_->code(NcGroup::Motion) >= 0 && words_->has_axes())
      place_.fail("G43.1 together with a motion: both use axis words");
    Vec3 length(0);
    for (std::size_t k = 0; k < 3; ++k)
      if (const char letter = "XYZ"[k]; words_->has(letter)) length[static_cast<int>(k)] = length_or_angle(k);
    if (!length_) length_ = length;
    frame.tip = length - *length_;
  } else if (code != 490) {
    length_.reset();
  }
  if (!(frame == frame_)) use_frame(frame);
}

void NcInterpreter::paths() {
  if (const int code = words_->code(NcGroup::PathControl); code >= 0) {
    modes_.path_control = code;
    if (code == 640)
      for (const char letter : {'P', 'Q'})
        if (words_->has(letter)) words_->value(letter, kMaxLength);
  }
  if (const int code = words_->code(NcGroup::Distance); code >= 0) modes_.absolute = code == 900;
  if (const int code = words_->code(NcGroup::ArcDistance); code >= 0) modes_.absolute_centre = code == 901;
  if (const int code = words_->code(NcGroup::ReturnLevel); code >= 0) modes_.return_level = code;
}

void NcInterpreter::subprograms() {
  const int code = words_->code(NcGroup::Subprogram);
  if (code == 980) {
    if (!words_->has('P')) place_.fail("M98 needs P");
    const int number = words_->whole('P');
    flow_->call_subprogram(number, words_->has('L') ? words_->whole('L') : 1);
  } else if (code == 990) {
    if (!flow_->end_subprogram()) ended_ = true;
    leave_saved_states();
  }
}

void NcInterpreter::stop() {
  const int code = words_->code(NcGroup::Stop);
  if (code != 20 && code != 300) return;
  ended_ = true;
  compensate(400);
}

}  // namespace riffler::nc
