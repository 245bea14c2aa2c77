// Knowledge of the tip's position, and lines, of Sinumerik programs.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "geom/directions.hpp"
#include "nc/limits.hpp"
#include "nc/machine/machines.hpp"
#include "nc/number_text.hpp"
#include "nc/read/sinumerik_interpreter.hpp"
#include "nc/read/tool_axis.hpp"

namespace riffler::nc {

namespace {

/// rad: tolerance between printed axes and a plane's normal.
constexpr double kAlongNormal = 1e-3;
/// rad: for given tool axes, a rotary axis stays where it is within this angle of the pole.
constexpr double kVectorAtPole = 1e-9;

std::string system_name(int system) {
  if (system < 0) return "the offset before it";
  return std::string("G") + std::to_string(system == 0 ? 500 : system <= 4 ? 53 + system : 500 + system);
}

}  // namespace

// --- Knowledge of the tip's position ---

void SinumerikInterpreter::check_length(const Vec3& at) const {
  for (int k = 0; k < 3; ++k)
    if (!(std::abs(at[k]) <= kMaxLength)) place_.fail(std::string(1, "XYZ"[k]) + " is out of range");
}

bool SinumerikInterpreter::is_away() const {
  return has_stand(stand_, Stand::Machine);
}

std::string SinumerikInterpreter::axes_away() const {
  return axes_of(stand_, Stand::Machine);
}

void SinumerikInterpreter::lose_place() {
  stand_.fill(Stand::Machine);
  leaving_.reset();
}

/// The only place that creates a row whose position in the part depends on the machine.
void SinumerikInterpreter::leave_part(const NcRowWords& words) {
  const bool begun = rows_->begun();
  if (begun && !std::exchange(position_noted_, true))
    note("machine position",
         "a machine position (SUPA, G53, G153, G74, CYCLE800, or rotary axes that turn without TRAORI): where it is in "
         "the part is not in the program; the moves there, and from there to the next position in the part, are "
         "neither cut nor compared");
  leaving_.reset();
  rows_->at_machine(words);
}

/// Rapids before X, Y and Z have all been programmed have an unknown end; a feed move takes the missing ones as 0.
void SinumerikInterpreter::begin_or_wait(bool rapid) {
  constexpr std::size_t kMax = 1000;  // rows; a program that keeps moving without one of them assumes 0
  const bool named = !has_stand(stand_, Stand::Start);
  begun_ = named || !rapid || rows_->held() > kMax;
  if (begun_)
    rows_->release(!named);
  else
    rows_->hold();
}

void SinumerikInterpreter::note_start() {
  const std::string axes = axes_of(stand_, Stand::Start, ", ");
  if (!axes.empty())
    note("start", axes + " was not programmed before the first feed move: assumed to be 0 at the start of the program");
}

/// Called before every motion in program coordinates: whether it ends in the part. Notes the assumptions.
bool SinumerikInterpreter::moves_in_part(const NcRowWords& words) {
  if (!units_said_ && !units_given_)
    note("units",
         "none of G70, G71, G700 and G710 before the first move: taken as the control's own unit, millimetres; option "
         "units");
  units_said_ = true;
  if (!begun_) begin_or_wait(words.rapid);
  const bool upright = keeps_tip_ || is_upright();
  if (!upright && !words.rapid) fail_tilted();
  const bool away = is_away();
  if (!away && upright) check_system();
  if (words.rapid) return upright && !away;
  if (away && !std::exchange(away_noted_, true))
    note("coordinates", "a feed move while " + axes_away() + " is at a machine position: neither cut nor checked");
  if (!std::exchange(start_noted_, true)) note_start();
  return !away;
}

/// The distance of a work offset from the first one is not in the program.
void SinumerikInterpreter::check_system() {
  if (!first_system_) first_system_ = system_;
  if (system_ == *first_system_) return;
  note_once(
      -100 - system_, "work offset",
      system_name(system_) + ": how far it is from " + system_name(*first_system_) +
          " is not in the program, assumed to be 0; read a program for each of them, or write the distance as TRANS");
}

void SinumerikInterpreter::keep_tip(bool on) {
  if (keeps_tip_ == on) return;
  keeps_tip_ = on;
  if (!on && !is_upright()) lose_place();
}

/// Whether the rotary axes stand such that X Y Z are the tip without TRAORI.
bool SinumerikInterpreter::is_upright() const {
  const Machine& machine = rows_->machine();
  if (!swivel_joints_)
    return std::all_of(rotary_.begin() + 3, rotary_.end(), [](double angle) { return is_whole_turn(angle); });
  const Vec3 normal = swivel_.turn[2];
  if (geom::angle_between(machine.pose(rotary_).axis, normal) > kAlongNormal) return false;
  if (machine.branches() < 2 || glm::length(glm::cross(machine.pole(), normal)) >= kAlongNormal) return true;
  return is_whole_turn(rotary_[machine.free_joint()] - (*swivel_joints_)[machine.free_joint()]);
}

void SinumerikInterpreter::fail_tilted() const {
  std::string shown;
  for (const char letter : rows_->machine().axes().substr(3))
    shown.append(shown.empty() ? "" : " ").append(1, letter).append(number_text(rotary_[joint_index(letter)], 3));
  place_.fail("a feed move with the rotary axes at " + shown +
              (swivel_joints_ ? ", which is not where CYCLE800 has turned them: leave them there, or have the post "
                                "write TRAORI"
                              : ", without TRAORI and without CYCLE800: where the tip is depends on the machine; have "
                                "the post write TRAORI or CYCLE800"));
}

// --- Targets ---

Vec3 SinumerikInterpreter::linear_target(const SinumerikWords& words) {
  using Meaning = SinumerikCoordinate::Meaning;
  Vec3 to = at_;
  for (std::size_t k = 0; k < 3; ++k) {
    const SinumerikCoordinate& axis = words.axes[k];
    if (!axis.given) continue;
    if (axis.meaning != Meaning::Modal && axis.meaning != Meaning::Absolute && axis.meaning != Meaning::Incremental)
      place_.fail("DC, ACP and ACN belong to rotary axes");
    const bool absolute = axis.is_absolute(absolute_);
    to[static_cast<int>(k)] = axis.value * unit_ + (absolute ? 0 : at_[static_cast<int>(k)]);
    if (absolute) stand_[k] = Stand::Given;
  }
  check_length(to);
  return to;
}

Joints SinumerikInterpreter::rotary_target(const SinumerikWords& words) {
  using Meaning = SinumerikCoordinate::Meaning;
  Joints to = rotary_;
  for (std::size_t k = 3; k < to.size(); ++k) {
    const SinumerikCoordinate& axis = words.axes[k];
    if (!axis.given) continue;
    const double now = rotary_[k];
    to[k] = axis.value;
    if (!axis.is_absolute(absolute_)) to[k] += now;
    if (axis.meaning == Meaning::Shortest) to[k] = nearest_turn(axis.value, now);
    if (axis.meaning == Meaning::Positive) to[k] += 360 * std::ceil((now - axis.value) / 360);
    if (axis.meaning == Meaning::Negative) to[k] += 360 * std::floor((now - axis.value) / 360);
    if (!(std::abs(to[k]) <= kMaxAngle)) place_.fail(std::string(1, kJointLetters[k]) + " is out of range");
  }
  return to;
}

Joints SinumerikInterpreter::in_part(const Vec3& at, const Joints& rotary) const {
  return rows_->machine().with_tip(rotary, frame_.to_part(at));
}

void SinumerikInterpreter::fail_axis(char letter) const {
  const std::string others = machines_with(letter, "sinumerik");
  place_.fail(std::string("unknown letter ") + letter + ": the machine has no such axis" +
              (others.empty() ? "; describe one that does" : "; these have: " + others));
}

// --- Motion ---

void SinumerikInterpreter::motion(SinumerikWords& words) {
  const bool moves = words.has_linear() || words.has_rotary() || words.has_vector();
  const bool arcs = motion_ > Motion::Line && words.has_centre();
  if (dwells_ || bounds_ || (!moves && !arcs)) return;
  for (const char letter : {'A', 'B', 'C'})
    if (words.axes[joint_index(letter)].given && rows_->machine().axes().find(letter) == std::string_view::npos)
      fail_axis(letter);
  if (homes_) return to_home(words);
  if (words.homes) place_.fail("X1=, Y1= and Z1= are axes of the machine, which G74 and G75 take: write X, Y and Z");
  if (taps_) return line(words, false);
  if (motion_ == Motion::None) place_.fail("axis words without a motion (G0, G1, G2, G3)");
  const bool rapid = motion_ == Motion::Rapid;
  if (by_machine_) {
    if (motion_ > Motion::Line) place_.fail("an arc in coordinates of the machine: G0 and G1 go there");
    to_machine(words, rapid);
  } else if (motion_ == Motion::Through) {
    arc_through(words);
  } else if (motion_ > Motion::Line) {
    arc(words, motion_);
  } else if (words.has_vector()) {
    vector_line(words, rapid);
  } else {
    line(words, rapid);
  }
  if (modal_cycle_ != 0 && !by_machine_) drill(modal_cycle_, modal_arguments_);
}

void SinumerikInterpreter::line(const SinumerikWords& words, bool rapid) {
  const NcRowWords row = row_words(rapid);
  const Joints rotary = rotary_target(words);
  if (rotary != rotary_ && !keeps_tip_) {
    if (!rapid)
      place_.fail(
          "a feed move in which rotary axes turn without TRAORI: the tip's path depends on the machine; have the post "
          "write TRAORI");
    lose_place();
    rotary_ = rotary;
    if (!words.has_linear()) return leave_part(row);
  }
  move_to(linear_target(words), rotary, row);
}

void SinumerikInterpreter::move_to(const Vec3& to, const Joints& rotary, const NcRowWords& words) {
  check_length(to);
  const Vec3 from = at_;
  const Turning way = turning_way_ == Turning::Unsaid ? by_system_ : turning_way_;
  if (!moves_in_part(words)) {
    if (!keeps_tip_ && !is_upright()) lose_place();
    leave_part(words);
  } else if (way == Turning::GreatCircle && rotary != rotary_ && !words.rapid) {
    const Joints joints = in_part(to, rotary);
    rows_->line_to_pose(in_part(at_, rotary_), joints, rows_->machine().pose(joints), words);
  } else {
    rows_->line(in_part(at_, rotary_), in_part(to, rotary), words);
  }
  at_ = to, rotary_ = rotary;
  if (to != from && !is_away()) leaving_ = glm::normalize(to - from);
}

/// The tool's axis by A3 B3 C3; missing ones are 0.
void SinumerikInterpreter::vector_line(const SinumerikWords& words, bool rapid) {
  if (!keeps_tip_) place_.fail("A3= B3= C3= without TRAORI: have the post write TRAORI before");
  if (words.has_rotary()) place_.fail("A3= B3= C3= together with rotary axes");
  if (machine_vectors_)
    place_.fail("A3= B3= C3= under ORIMKS are in coordinates of the machine: have the post write ORIWKS");
  const Vec3 given(words.vector[0].value_or(0), words.vector[1].value_or(0), words.vector[2].value_or(0));
  const double length = glm::length(given);
  if (!(length > 1e-6 && length < 1e6)) place_.fail("A3= B3= C3= are not a direction");
  const Vec3 axis = frame_.turn * (given / length);
  const NcRowWords row = row_words(rapid);
  const Vec3 from = at_, to = linear_target(words);
  Joints rotary;
  try {
    rotary = joints_holding(rows_->machine(), glm::normalize(axis), rotary_, kVectorAtPole);
  } catch (const std::invalid_argument& e) {
    place_.fail(std::string(e.what()) + ": read it with the machine that the program is for");
  }
  if (turning_way_ == Turning::Axes || rapid) return move_to(to, rotary, row);
  if (moves_in_part(row))
    rows_->line_to_pose(in_part(from, rotary_), in_part(to, rotary), {frame_.to_part(to), glm::normalize(axis)}, row);
  else
    leave_part(row);
  at_ = to, rotary_ = rotary;
  if (to != from && !is_away()) leaving_ = glm::normalize(to - from);
}

/// SUPA, G153, G53: relative to the machine's zero.
void SinumerikInterpreter::to_machine(const SinumerikWords& words, bool rapid) {
  const NcRowWords row = row_words(rapid);
  const Joints rotary = rotary_target(words);
  const bool square = is_upright() && frame_.turn == Mat3(1) && rotary == rotary_;
  if (!square) lose_place();
  for (std::size_t k = 0; k < 3; ++k)
    if (words.axes[k].given) stand_[k] = Stand::Machine;
  if (words.has_rotary())
    note_once(-13, "machine position", "rotary axes stand at the machine's zero where the part's is");
  if (words.has_vector()) place_.fail("A3= B3= C3= in coordinates of the machine");
  rotary_ = rotary;
  leave_part(row);
}

/// G74, G75: to reference or fixed points.
void SinumerikInterpreter::to_home(const SinumerikWords& words) {
  for (std::size_t k = 0; k < 3; ++k)
    if (words.axes[k].given) stand_[k] = Stand::Machine;
  if (words.has_rotary()) place_.fail("G74 and G75 with rotary axes: where these stand is not in the program");
  if (frame_.turn != Mat3(1)) lose_place();
  leave_part({true, 0, false, turning_ * speed_, tool_, calls_.front().line});
}

}  // namespace riffler::nc
