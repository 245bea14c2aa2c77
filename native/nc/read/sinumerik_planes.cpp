// Frames and tilted planes of Sinumerik programs: TRANS, ROT, CYCLE800.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "nc/limits.hpp"
#include "nc/read/heidenhain_frame.hpp"
#include "nc/read/sinumerik_interpreter.hpp"
#include "nc/read/tool_axis.hpp"

namespace riffler::nc {

namespace {

/// rad: within this angle of the pole a rotary axis stays where it is.
constexpr double kPlaneAtPole = 1e-6;

Mat3 turn_about(std::size_t axis, double degrees) {
  Vec3 angles(0);
  angles[static_cast<int>(axis)] = degrees;
  return spatial_turn(angles);
}

}  // namespace

bool SinumerikInterpreter::execute_frame(const std::string& word, SinumerikCursor& cursor) {
  const bool adds = word == "ATRANS" || word == "AROT";
  const bool replaces = word == "TRANS" || word == "ROT";
  const bool refused = word == "MIRROR" || word == "SCALE" || word == "AMIRROR" || word == "ASCALE";
  if (!adds && !replaces && !refused) return false;
  // Any of them without words cancels all of TRANS, ROT, SCALE and MIRROR.
  if (cursor.peek() == '\0' && (refused || replaces)) {
    use_frames(swivel_, {});
    return true;
  }
  if (refused) refuse(word);
  const SinumerikFrame frame = frame_of(word, cursor);
  use_frames(swivel_, adds ? programmed_.with(frame) : frame);
  return true;
}

SinumerikFrame SinumerikInterpreter::frame_of(const std::string& word, SinumerikCursor& cursor) {
  SinumerikWords words;
  words.read(cursor, values_, [&](const std::string&, SinumerikCursor&) {
    place_.fail(word + " takes X Y Z" + (word.ends_with("ROT") ? " or RPL=" : "") + " in a block of its own");
  });
  Vec3 of(0);
  for (std::size_t k = 0; k < words.axes.size(); ++k) {
    const SinumerikCoordinate& axis = words.axes[k];
    if (axis.given && axis.meaning != SinumerikCoordinate::Meaning::Modal) place_.fail(word + " with AC or IC");
    if (k >= 3 && axis.value != 0)
      place_.fail(word + " with a rotary axis is not read: have the post write its angles");
    if (k < 3) of[static_cast<int>(k)] = axis.value;
  }
  if (!words.codes.empty() || !words.functions.empty() || words.feed || words.speed || words.tool || words.has_vector())
    place_.fail(word + " needs a block of its own");
  const bool turns = word == "ROT" || word == "AROT";
  if (words.plane_angle && (!turns || of != Vec3(0))) place_.fail("RPL belongs to ROT and AROT, without X Y Z");
  if (!turns) {
    of *= unit_;
    check_length(of);
    return {Mat3(1), of};
  }
  if (words.plane_angle) of[static_cast<int>(plane_[2])] = *words.plane_angle;
  for (int k = 0; k < 3; ++k)
    if (!(std::abs(of[k]) <= kMaxAngle)) place_.fail("an angle of " + word + " is out of range");
  // For several angles: about Z, then the new Y, then the new X.
  return {spatial_turn(of), Vec3(0)};
}

/// Changes the frames; the tool does not move.
void SinumerikInterpreter::use_frames(const SinumerikFrame& swivel, const SinumerikFrame& programmed) {
  const SinumerikFrame frame = swivel.with(programmed);
  swivel_ = swivel, programmed_ = programmed;
  if (frame == frame_) return;
  const Vec3 part = frame_.to_part(at_);
  const bool turns = frame.turn != frame_.turn;
  frame_ = frame;
  at_ = frame_.from_part(part);
  check_length(at_), check_length(frame_.shift);
  leaving_.reset();
  if (!turns) return;
  // Each coordinate of the new frame depends on all previous ones.
  if (is_away()) lose_place();
  if (has_stand(stand_, Stand::Start)) stand_.fill(Stand::Start);
}

/// CYCLE800(retraction, "swivel data", state, mode, X0, Y0, Z0, A, B, C, X1, Y1, Z1, direction, ...).
void SinumerikInterpreter::swivel(SinumerikCursor& cursor) {
  if (!cursor.take_if("(")) cursor.fail("CYCLE800 needs brackets: CYCLE800()");
  SinumerikCursor ahead = cursor;
  std::string data;
  if (ahead.peek() != ')') {
    while (ahead.peek() != ',' && ahead.peek() != '\0' && ahead.peek() != ')') ahead.take();
    if (ahead.take_if(",") && ahead.peek() == '"') data = ahead.quoted();
  }
  const Arguments given = arguments(cursor);
  cursor.expect_end();
  const auto of = [&](std::size_t k) { return k < given.size() ? given[k].value_or(0) : 0; };
  const bool retracts = of(0) != 0;
  if (given.empty() || data == "0") return unswivel(retracts);
  const auto whole = [&](std::size_t k) {
    if (!(of(k) >= 0 && of(k) <= kMaxNumber && of(k) == std::floor(of(k))))
      place_.fail("a number of CYCLE800 is not a whole number, or is negative");
    return static_cast<int>(of(k));
  };
  const int state = whole(2), mode = whole(3), adds = state % 10;
  if (adds > 1 || state / 100 % 10 != 0 || state / 10'000 % 10 != 0)
    place_.fail(std::string("CYCLE800 with state ") + std::to_string(state) +
                " is not read: new or additional planes that turn the axes are; have the post write those");
  // The axis of each angle: three pairs of bits, the first pair lowest.
  const std::size_t order[] = {static_cast<std::size_t>(mode & 3), static_cast<std::size_t>(mode >> 2 & 3),
                               static_cast<std::size_t>(mode >> 4 & 3)};
  if (mode >= 64 || std::ranges::count(order, std::size_t{0}) > 0 || order[0] == order[1] || order[1] == order[2] ||
      order[0] == order[2])
    place_.fail(std::string("CYCLE800 with mode ") + std::to_string(mode) +
                " is not read: angles axis by axis (57 for X, Y, Z) are; have the post write them");
  Mat3 turn(1);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(std::abs(of(7 + k)) <= kMaxAngle)) place_.fail("an angle of CYCLE800 is out of range");
    turn = turn * turn_about(order[k] - 1, of(7 + k));
  }
  const Vec3 before = unit_ * Vec3(of(4), of(5), of(6)), after = unit_ * Vec3(of(10), of(11), of(12));
  // Without a direction, sets the plane but does not move the axes.
  swivel_to(turn, before, after, adds == 1, retracts, of(13) != 0);
}

void SinumerikInterpreter::swivel_to(const Mat3& turn, const Vec3& before, const Vec3& after, bool adds, bool retracts,
                                     bool turns) {
  if (keeps_tip_) place_.fail("CYCLE800 under TRAORI: have the post write TRAFOOF before it");
  if (plane_[2] != 2) place_.fail("CYCLE800 outside of G17 is not read: have the post write G17 before it");
  if (adds && !(programmed_ == SinumerikFrame{}))
    place_.fail("CYCLE800 that adds to TRANS or ROT is not read: have the post write a new plane");
  const SinumerikFrame frame = (adds ? swivel_ : SinumerikFrame{}).with({turn, before}).with({Mat3(1), after});
  Joints joints;
  try {
    joints = joints_holding(rows_->machine(), glm::normalize(frame.turn[2]), rotary_, kPlaneAtPole);
  } catch (const std::invalid_argument& e) {
    place_.fail(std::string(e.what()) + " of CYCLE800's plane: read it with the machine that the program is for");
  }
  const bool stays = joints == rotary_ || !turns;
  use_frames(frame, {});
  swivel_joints_ = joints;
  if (stays && !retracts) return;
  if (turns) rotary_ = joints;
  lose_place();
  leave_part({true, 0, false, turning_ * speed_, tool_, calls_.front().line});
}

/// Returns to coordinates without a plane. Whether the axes then turn back depends on the machine's setup.
void SinumerikInterpreter::unswivel(bool retracts) {
  const bool moves = retracts || !is_upright() || swivel_joints_.has_value();
  const bool turned =
      std::any_of(rotary_.begin() + 3, rotary_.end(), [](double angle) { return !is_whole_turn(angle); });
  use_frames({}, {});
  swivel_joints_.reset();
  if (!moves && !turned) return;
  lose_place();
  leave_part({true, 0, false, turning_ * speed_, tool_, calls_.front().line});
}

}  // namespace riffler::nc
