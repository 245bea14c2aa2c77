// Cutter radius compensation: G40, G41, G42, G41.1, G42.1.
#include <algorithm>
#include <cmath>
#include <string>

#include "geom/hypot.hpp"
#include "nc/limits.hpp"
#include "nc/read/interpreter.hpp"

namespace riffler::nc {

void NcInterpreter::make_compensation() {
  compensation_ = std::make_unique<CutterCompensation>(place_, [this](const CentreMove& move) {
    const CutterOffset& by = compensation_->offset();
    if (move.arc)
      rows_->arc(move.from, move.to, *move.arc, by.u, by.v, move.words);
    else
      rows_->line(move.from, move.to, move.words);
  });
}

void NcInterpreter::compensate(int code) {
  if (code == 400) {
    compensation_->off();
    compensation_code_ = code;
    return;
  }
  const std::string name = nc_code_name('G', code);
  if (given_.compensation == CompensationRule::Error) place_.fail(compensation_refused(name));
  if (given_.compensation == CompensationRule::Ignore) {
    words_->pass_over("DL");
    if (!compensation_noted_) note("cutter compensation", compensation_ignored(name));
    compensation_noted_ = true;
    return;
  }
  if (modes_.plane[2] == 0) place_.fail("cutter compensation (" + name + ") in the plane of G19: G17 and G18 are read");
  const bool by_diameter = code == 411 || code == 421;
  if (by_diameter && !words_->has('D')) place_.fail(name + " needs D, the tool's diameter");
  const CutterOffset before = compensation_->offset();
  compensation_code_ = code;
  compensation_diameter_.reset();
  if (by_diameter)
    compensation_diameter_ = words_->value('D', kMaxLength) * modes_.unit;
  else if (words_->has('D'))
    diameter_number_ = words_->whole('D');
  if (!compensation_->is_on()) return;
  const double diameter = compensation_diameter();
  if (before.radius != std::abs(diameter) / 2 || before.side != compensation_side(diameter))
    place_.fail(name + " changes the compensation that holds: G40 and a straight move before it");
}

/// D without G41 or G42: the number of the offset that they use, as on Fanuc controls.
void NcInterpreter::choose_offset() {
  if (!words_->has('D') || words_->code(NcGroup::SpindleMode) == 960) return;
  words_->pass_over("D");
  if (words_->code(NcGroup::CutterCompensation) > 400 || given_.compensation != CompensationRule::Offset) return;
  diameter_number_ = words_->whole('D');
  if (compensation_->is_on() && std::abs(compensation_diameter()) / 2 != compensation_->offset().radius)
    place_.fail("D changes the compensation that holds: G40 and a straight move before it");
}

/// Diameter in mm: of G41.1 in the block; otherwise of the offset that D names, or of the tool in the spindle.
double NcInterpreter::compensation_diameter() {
  if (compensation_diameter_) return *compensation_diameter_;
  const int number = diameter_number_.value_or(tool_);
  if (diameter_number_ && number == 0) return 0;
  const auto own = tool_radii_.find(number);
  std::optional<double> diameter = diameters_.of(number);
  if (!diameter && own != tool_radii_.end()) diameter = 2 * own->second;
  const std::string shown = diameter_number_ ? "offset D" + std::to_string(number) : "tool " + std::to_string(number);
  const std::string name = nc_code_name('G', compensation_code_);
  if (!diameter) place_.fail(diameter_unknown(name, shown, number));
  if (offsets_noted_.insert(number).second) note("cutter compensation", path_is_offset(name, shown, *diameter / 2));
  return *diameter;
}

CutterSide NcInterpreter::compensation_side(double diameter) const {
  const bool left = compensation_code_ < 420;
  return left == (diameter >= 0) ? CutterSide::Left : CutterSide::Right;
}

/// Whether the next move is offset. The first one after G41 begins the compensation.
bool NcInterpreter::compensates() {
  if (compensation_->is_on()) return true;
  if (compensation_code_ == 400) return false;
  const double diameter = compensation_diameter();
  if (diameter == 0) return false;
  check_stands_in_part("cutter compensation begins");
  const auto [u, v, w] = modes_.plane;
  compensation_->on({compensation_side(diameter), std::abs(diameter) / 2, u, v}, at_);
  return true;
}

/// A line (code 0 or 10) or an arc of the contour.
void NcInterpreter::contour_to(const Joints& to, int code) {
  for (std::size_t k = 3; k < to.size(); ++k)
    if (to[k] != at_[k])
      place_.fail(std::string("rotary axes turn in cutter compensation (") + kJointLetters[k] +
                  "): G40 and a straight move before it");
  NcRowWords words = row_words(code == 0);
  std::optional<Arc> arc;
  if (code > 10) arc = arc_of_words(to, code == 20);
  if (words.inverse_time) {
    // The duration is that of the programmed length.
    const auto [u, v, w] = modes_.plane;
    const double along = arc ? arc->length() : geom::hypot(to[u] - at_[u], to[v] - at_[v]);
    words.feed = std::min(words.feed * geom::hypot(along, to[w] - at_[w]), kMaxFeed);
    words.inverse_time = false;
  }
  moves_in_part(false);
  if (arc)
    compensation_->arc(to, *arc, words);
  else
    compensation_->line(to, words);
  at_ = to;
}

void NcInterpreter::refuse_in_compensation(const std::string& what) const {
  if (compensation_->is_on()) place_.fail(what + " in cutter compensation: G40 and a straight move before it");
}

/// Between G40 and the next move the tool stays at the offset point next to the programmed one.
void NcInterpreter::leave_contour(const Joints& to, bool in_part) {
  if (!compensation_->is_leaving()) return;
  const CutterOffset& by = compensation_->offset();
  if (in_part && to[by.u] == at_[by.u] && to[by.v] == at_[by.v])
    note("cutter compensation",
         "the move after G40 has no motion in the plane: it goes from the offset path to the contour's last point, as "
         "in LinuxCNC; other controls stay on the offset path");
  compensation_->end_leaving();
}

void NcInterpreter::check_not_leaving() const {
  if (compensation_->is_leaving()) place_.fail("the move after G40 is not straight: write G0 or G1 before it");
}

}  // namespace riffler::nc
