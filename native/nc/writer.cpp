#include "nc/writer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <optional>
#include <stdexcept>

#include "geom/io.hpp"
#include "nc/limits.hpp"
#include "nc/rotary.hpp"

namespace riffler {

namespace {

constexpr int kLengthDecimals = 5, kAngleDecimals = 6;
constexpr double kMaxRotary = 3600;  // deg/min, where nothing else is said: ten turns a minute
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

std::int64_t scale(int decimals) {
  std::int64_t s = 1;
  while (decimals-- > 0) s *= 10;
  return s;
}

/// `value` in units of its last printed decimal: what is equal here is equal in print.
std::int64_t ticks(double value, int decimals) {
  return std::llround(value * static_cast<double>(scale(decimals)));
}

void put_integer(std::string& out, std::int64_t value) {
  char digits[24];
  out.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// Fixed decimals; `trim` drops zeros at the end and a bare point.
void put_ticks(std::string& out, std::int64_t value, int decimals, bool trim = false) {
  if (value < 0) out += '-';
  const std::int64_t size = std::abs(value);
  put_integer(out, size / scale(decimals));
  std::string rest;
  put_integer(rest, size % scale(decimals));
  rest.insert(0, static_cast<std::size_t>(decimals) - rest.size(), '0');
  if (trim) rest.erase(rest.find_last_not_of('0') + 1);
  if (!rest.empty()) out += '.', out += rest;
}

std::string number(double value, int decimals = 6) {
  if (!(std::abs(value) < 1e9)) return "out of range";  // only sizes in comments can be
  std::string out;
  put_ticks(out, ticks(value, decimals), decimals, true);
  return out;
}

/// Text that is safe inside a comment on any control: printable ASCII without brackets, not too long.
std::string plain(std::string_view text) {
  constexpr std::size_t kLongest = 200;
  std::string out;
  for (const char c : text.substr(0, kLongest)) {
    const bool ascii = c >= ' ' && c <= '~';
    out += c == '(' ? '[' : c == ')' ? ']' : ascii ? c : '?';
  }
  return out;
}

class Writer {
 public:
  Writer(const Program& program, const WriteOptions& options)
      : program_(program),
        options_(options),
        taken_(options.options, "post " + options.post),
        machine_(make_machine(options.post, taken_)),
        splitter_(*machine_, options.tolerance, options.axis_tolerance),
        max_rotary_(taken_.positive("max_rotary").value_or(kMaxRotary)) {
    taken_.done();
    if (!(options.tolerance >= 2e-5 && options.tolerance <= kMaxLength))
      throw std::invalid_argument("tolerance must be a length of at least 0.00002 mm: lengths have 5 decimals");
    if (!(options.axis_tolerance >= 1e-7 && options.axis_tolerance <= 1))
      throw std::invalid_argument("axis_tolerance must be at least 1e-7 rad (angles have 6 decimals) and at most 1");
  }

  std::string run() {
    const std::vector<Joints> joints = choose_joints(program_, *machine_, options_.axis_tolerance);
    header();
    for (std::size_t row = 0; row < program_.size(); ++row) {
      set_up(row);
      const bool rapid = program_.rapid()[row];
      if (row == 0) {
        block(row, joints[row], rapid, true);
        continue;
      }
      const std::vector<Pose>& poses = program_.poses();
      const auto& parts = splitter_.split(poses[row - 1], joints[row - 1], poses[row], joints[row], rapid);
      for (std::size_t k = 0; k < parts.size(); ++k) block(row, parts[k], rapid, k + 1 == parts.size());
    }
    if (spindle_ != 0) text_ += "M5\n";
    text_ += "G49\nM30\n";
    return std::move(text_);
  }

 private:
  void line(std::initializer_list<std::string_view> parts) {
    for (const std::string_view part : parts) text_ += part;
    text_ += '\n';
  }

  void comment(std::initializer_list<std::string_view> parts) {
    std::string text;
    for (const std::string_view part : parts) text += part;
    line({"(", plain(text), ")"});
  }

  void header() {
    comment({"Riffler, post ", options_.post});
    comment({machine_->meaning()});
    comment({"mm, degrees, feed in mm/min at the tip; tolerance ", number(options_.tolerance), " mm, axis ",
             number(options_.axis_tolerance, 8), " rad"});
    for (auto [key, value] : program_.provenance) {
      // "(LOGOPEN," and its like are commands to LinuxCNC.
      std::replace(key.begin(), key.end(), ',', ' ');
      comment({key, ": ", value});
    }
    for (const auto& [number, tool] : program_.tools) comment({"T", std::to_string(number), ": ", describe(tool)});
    text_ += "G21 G90 G94\nG17 G40 G49 G80 G54\n";
  }

  static std::string describe(const Tool& tool) {
    std::string out = tool.kind();
    for (const auto& [name, value] : tool.parameters()) out += ", " + name + " " + number(value);
    return tool.name().empty() ? out : out + ", named " + tool.name();
  }

  /// Tool and spindle as the row wants them, before its first block.
  void set_up(std::size_t row) {
    const int tool = program_.tool()[row];
    const double spindle = program_.spindle()[row];
    const bool change = row == 0 || tool != tool_;
    if (change) {
      if (row > 0) {
        if (spindle_ != 0) text_ += "M5\n";
        text_ += "G49\n";
        spindle_ = 0;
      }
      if (tool > 0) line({"T", std::to_string(tool), " M6"});
      tool_ = tool;
    }
    if (spindle != spindle_) {
      if (spindle == 0)
        text_ += "M5\n";
      else
        line({"S", number(std::abs(spindle)), spindle > 0 ? " M3" : " M4"});
      spindle_ = spindle;
    }
    if (change) {
      line({machine_->offset_block(tool)});
      // A control may lose its modes in a tool change, and an offset moves the coordinates: say everything again.
      printed_.fill(kNever);
      motion_ = ' ';
      feed_ = kNever;
      if (inverse_) text_ += "G94\n", inverse_ = false;
    }
  }

  /// One block; `must`: a row ends here, so that it is written even where nothing moves.
  void block(std::size_t row, const Joints& joints, bool rapid, bool must) {
    std::string words;
    bool turns = false;
    for (const char letter : machine_->axes())
      if (axis_word(words, row, letter, joints, false)) turns |= joint_index(letter) >= 3;
    if (words.empty() && !must) return;
    if (words.empty()) axis_word(words, row, machine_->axes().front(), joints, true);
    const bool inverse = !rapid && turns && machine_->joint_words() && stands_;
    std::string code;
    if (!rapid && inverse != inverse_) code = inverse ? "G93 " : "G94 ", inverse_ = inverse, feed_ = kNever;
    const char motion = rapid ? '0' : '1';
    if (motion != motion_ || !code.empty()) code += std::string("G") + motion;
    motion_ = motion;
    if (code.empty()) words.erase(0, 1);
    text_ += code, text_ += words;
    if (!rapid && inverse)
      time_word(row, joints);
    else if (!rapid)
      feed_word(row);
    text_ += '\n';
    stands_ = joints;
  }

  bool axis_word(std::string& text, std::size_t row, char letter, const Joints& joints, bool always) {
    const std::size_t k = joint_index(letter);
    const bool angle = k >= 3;
    if (!(std::abs(joints[k]) <= (angle ? kMaxAngle : kMaxLength)))
      throw std::invalid_argument("poses, row " + std::to_string(row) + ": " + letter + " is out of range");
    const int decimals = angle ? kAngleDecimals : kLengthDecimals;
    const std::int64_t value = ticks(joints[k], decimals);
    if (value == printed_[k] && !always) return false;
    printed_[k] = value;
    text += ' ';
    text += letter;
    put_ticks(text, value, decimals);
    return true;
  }

  void feed_word(std::size_t row) {
    const std::int64_t value = feed_of(row);
    if (value == feed_) return;
    feed_ = value;
    text_ += " F";
    put_ticks(text_, value, kFeedDecimals, true);
  }

  /// Under G93: 1 / minutes, on every block. The tip's way at the row's feed, or as fast as the rotary axes may turn,
  /// whichever takes longer.
  void time_word(std::size_t row, const Joints& joints) {
    const double way = glm::length(machine_->pose(joints).tip - machine_->pose(*stands_).tip);
    double degrees = 0;
    for (std::size_t k = 3; k < joints.size(); ++k) degrees = std::max(degrees, std::abs(joints[k] - (*stands_)[k]));
    const double feed = program_.feed()[row];
    const double minutes = std::max({feed > 0 ? way / feed : 0.0, degrees / max_rotary_, 1 / kMaxFeed});
    text_ += " F";
    put_ticks(text_, std::max<std::int64_t>(1, ticks(1 / minutes, kFeedDecimals)), kFeedDecimals, true);
  }

  /// A row in which the tip stands still has no feed of its own: the one before goes on, or the next to come.
  std::int64_t feed_of(std::size_t row) const {
    const std::vector<double>& feed = program_.feed();
    if (feed[row] == 0 && feed_ != kNever) return feed_;
    const auto own =
        std::find_if(feed.begin() + static_cast<std::ptrdiff_t>(row), feed.end(), [](double f) { return f > 0; });
    if (own == feed.end()) throw std::invalid_argument("feed, row " + std::to_string(row) + ": no feed is known");
    return std::max<std::int64_t>(1, ticks(*own, kFeedDecimals));
  }

  static constexpr int kFeedDecimals = 6;

  const Program& program_;
  const WriteOptions& options_;
  OptionReader taken_;
  std::unique_ptr<Machine> machine_;
  Subdivider splitter_;

  std::string text_;
  std::array<std::int64_t, 6> printed_{};
  char motion_ = ' ';
  bool inverse_ = false;          // G93
  std::optional<Joints> stands_;  // after the last block
  double max_rotary_;             // deg/min
  std::int64_t feed_ = kNever;
  int tool_ = 0;
  double spindle_ = 0;
};

}  // namespace

std::string to_nc(const Program& program, const WriteOptions& options) {
  return Writer(program, options).run();
}

void write_nc(const Program& program, const std::filesystem::path& path, const WriteOptions& options) {
  write_file(path, to_nc(program, options));
}

}  // namespace riffler
