// RS-274 as read by LinuxCNC and Fanuc-style controls.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>

#include "nc/number_text.hpp"
#include "nc/write/post.hpp"

namespace riffler::nc {

namespace {

class Rs274 final : public Post {
 public:
  using Post::Post;

  bool has_arcs() const override { return true; }

  void begin(std::span<const std::string> comments) override {
    for (const std::string& comment : comments) line({"(", plain(comment), ")"});
    code({"G21 G90 G94"});
    code({"G17 G40 G49 G80 G54"});
    for (const std::string& own : machine_.control().start) code({own});
  }

  void change_tool(int number, const Tool*, bool first) override {
    if (!first) {
      if (turns_) code({"M5"});
      code({"G49"});
      turns_ = false;
    }
    retract(), moves_ = true;
    if (number > 0) code({"T", std::to_string(number), " M6"});
  }

  void spindle(double speed) override {
    if (speed == 0)
      code({"M5"});
    else
      code({"S", number_text(std::abs(speed)), speed > 0 ? " M3" : " M4"});
    turns_ = speed != 0;
  }

  void ready(int tool) override {
    if (options_.coolant != "off") code({options_.coolant == "flood" ? "M8" : "M7"});
    if (inverse_) code({"G94"}), inverse_ = false;
    if (comes_safely())
      coming_ = tool;
    else
      count_length(tool);
    // A control may lose its modes in a tool change, and an offset moves the coordinates: write everything again.
    forget();
  }

  void block(const PostBlock& b) override {
    if (coming_) return come(b);
    words_.clear();
    for (const char letter : machine_.axes()) word(letter, b.joints[joint_index(letter)], false);
    if (words_.empty() && !b.must) return;
    if (words_.empty()) word(machine_.axes().front(), b.joints[0], true);
    motion(b, b.rapid ? '0' : '1');
  }

  void arc(const PostArc& a) override {
    constexpr std::string_view kPlanes[] = {"G19", "G18", "G17"};
    words_.clear();
    if (a.normal != normal_) code({kPlanes[a.normal]}), normal_ = a.normal;
    for (const char letter : machine_.axes()) word(letter, a.end.joints[joint_index(letter)], false);
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == a.normal) continue;
      words_ += ' ', words_ += "IJK"[k];
      const auto axis = static_cast<int>(k);
      put_ticks(words_, ticks(a.centre[axis] - a.from[axis], kLengthDecimals), kLengthDecimals);
    }
    motion(a.end, a.clockwise ? '2' : '3');
  }

  void end() override {
    if (turns_) code({"M5"});
    if (options_.coolant != "off") code({"M9"});
    code({"G49"});
    if (inverse_) code({"G94"});
    if (normal_ != 2) code({"G17"});
    if (moves_) retract();
    for (const std::string& own : machine_.control().end) code({own});
    code({"M30"});
  }

 private:
  void line(std::initializer_list<std::string_view> parts) {
    for (const std::string_view part : parts) text_ += part;
    text_ += '\n';
  }

  /// A line with its number.
  void code(std::initializer_list<std::string_view> parts) {
    number_line();
    line(parts);
  }

  void number_line() {
    if (options_.line_numbers == 0) return;
    // LinuxCNC reads five digits; after the largest number, start again.
    line_number_ =
        line_number_ + options_.line_numbers > 99'999 ? options_.line_numbers : line_number_ + options_.line_numbers;
    text_ += 'N' + std::to_string(line_number_) + ' ';
  }

  void retract() {
    if (options_.retract)
      code({"G53 G0 Z", number_text(*options_.retract, kLengthDecimals)});
    else if (options_.safe_start)
      for (const std::string& own : machine_.control().retract) code({own});
    forget();
  }

  void count_length(int tool) { code({machine_.control().tool_length, " H", std::to_string(tool)}); }

  /// Before a tool's first block, from the retracted position: turns the rotary axes before the control keeps the tip
  /// in place, then moves across, then down.
  void come(const PostBlock& b) {
    const int tool = *std::exchange(coming_, std::nullopt);
    const std::string_view axes = machine_.axes();
    const auto go = [&](std::string_view letters) {
      words_.clear();
      for (const char letter : letters) word(letter, b.joints[joint_index(letter)], true);
      if (words_.empty()) return;
      PostBlock there;
      there.rapid = true;
      motion(there, '0');
      --blocks_;  // one per row
    };
    // If X Y Z are the tip, activating the tool's length may make the control keep the tip in place.
    if (machine_.joint_words()) count_length(tool);
    go(axes.substr(3));
    if (!machine_.joint_words()) count_length(tool);
    motion_ = ' ';
    go("XY");
    words_.clear();
    word('Z', b.joints[2], true);
    motion(b, b.rapid ? '0' : '1');
  }

  void forget() {
    printed_.fill(kNever);
    motion_ = ' ';
    feed_ = kNever;
  }

  void word(char letter, double value, bool always) {
    const std::size_t k = joint_index(letter);
    const int decimals = k >= 3 ? kAngleDecimals : kLengthDecimals;
    const std::int64_t print = ticks(value, decimals);
    if (print == printed_[k] && !always) return;
    printed_[k] = print;
    words_ += ' ', words_ += letter;
    put_ticks(words_, print, decimals);
  }

  void motion(const PostBlock& b, char motion) {
    ++blocks_;
    number_line();
    bool said = false;
    if (!b.rapid && b.inverse != inverse_) {
      text_ += b.inverse ? "G93 " : "G94 ";
      inverse_ = b.inverse, feed_ = kNever, said = true;
    }
    if (motion != motion_ || said) text_ += 'G', text_ += motion, said = true;
    motion_ = motion;
    text_.append(words_, said ? 0 : 1);
    if (!b.rapid) feed(b);
    text_ += '\n';
  }

  void feed(const PostBlock& b) {
    const std::int64_t print = std::max<std::int64_t>(1, ticks(b.inverse ? 1 / b.minutes : b.feed, kFeedDecimals));
    if (print == feed_ && !b.inverse) return;
    feed_ = print;
    text_ += " F";
    put_ticks(text_, print, kFeedDecimals, true);
  }

  std::string words_;
  std::array<std::int64_t, 6> printed_{kNever, kNever, kNever, kNever, kNever, kNever};
  std::int64_t feed_ = kNever;
  char motion_ = ' ';
  std::size_t normal_ = 2;
  bool inverse_ = false;  // G93
  bool turns_ = false, moves_ = false;
  std::optional<int> coming_;  // the tool whose first block follows
  int line_number_ = 0;
};

}  // namespace

std::unique_ptr<Post> make_rs274(const Machine& machine, PostOptions options) {
  return std::make_unique<Rs274>(machine, std::move(options));
}

}  // namespace riffler::nc
