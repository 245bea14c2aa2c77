// Sinumerik 840D and 828D (Siemens, Programming Manual Job Planning, "Five-axis transformation"): the control keeps the
// tip under TRAORI; blocks contain the rotary axes.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "nc/number_text.hpp"
#include "nc/write/post.hpp"

namespace riffler::nc {

namespace {

class Sinumerik final : public Post {
 public:
  Sinumerik(const Machine& machine, PostOptions options) : Post(machine, std::move(options)) {
    if (machine.joint_words())
      throw std::invalid_argument("machine " + machine.name() +
                                  ": code for a Sinumerik control has tip coordinates (TRAORI): tcp must not be False");
  }

  bool has_arcs() const override { return true; }

  void begin(std::span<const std::string> comments) override {
    for (const std::string& comment : comments) text_.append("; ").append(plain(comment)) += '\n';
    line("G710 G90 G94 G17 G40 G54");
    for (const std::string& own : machine_.control().start) line(own);
  }

  void change_tool(int number, const Tool*, bool first) override {
    if (!first) {
      transform(false);
      if (turns_) line("M5");
      turns_ = false;
    }
    retract(), moves_ = true;
    if (number > 0) line(std::string("T") + std::to_string(number) + " M6");
    line("D1");
  }

  void spindle(double speed) override {
    line(speed == 0 ? "M5" : std::string("S") + number_text(std::abs(speed)) + (speed > 0 ? " M3" : " M4"));
    turns_ = speed != 0;
  }

  void ready(int) override {
    if (options_.coolant != "off") line(options_.coolant == "flood" ? "M8" : "M7");
    forget();
    coming_ = comes_safely();
    if (!coming_) transform(true);
  }

  void block(const PostBlock& b) override {
    if (coming_) come(b);
    std::string words;
    for (const char letter : machine_.axes()) word(words, letter, b.joints[joint_index(letter)], false);
    if (words.empty() && !b.must) return;
    if (words.empty()) word(words, 'X', b.joints[0], true);
    motion(b, b.rapid ? '0' : '1', words);
  }

  void arc(const PostArc& a) override {
    constexpr std::string_view kPlanes[] = {"G19", "G18", "G17"};
    if (a.normal != normal_) line(std::string(kPlanes[a.normal])), normal_ = a.normal;
    std::string words;
    for (const char letter : machine_.axes()) word(words, letter, a.end.joints[joint_index(letter)], false);
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == a.normal) continue;
      const auto axis = static_cast<int>(k);
      words.append(" ").append(1, "IJK"[k]);
      put_ticks(words, ticks(a.centre[axis] - a.from[axis], kLengthDecimals), kLengthDecimals);
    }
    motion(a.end, a.clockwise ? '2' : '3', words);
  }

  void end() override {
    transform(false);
    if (turns_) line("M5");
    if (options_.coolant != "off") line("M9");
    if (normal_ != 2) line("G17");
    if (moves_) retract();
    for (const std::string& own : machine_.control().end) line(own);
    line("M30");
  }

 private:
  void line(const std::string& text) {
    number_ += options_.line_numbers;
    if (number_ > 0) text_.append("N").append(std::to_string(number_)).append(" ");
    text_.append(text) += '\n';
  }

  void retract() {
    if (options_.retract)
      line("SUPA G0 Z" + number_text(*options_.retract, kLengthDecimals) + " D0");
    else if (options_.safe_start)
      for (const std::string& own : machine_.control().retract) line(own);
    forget();
  }

  /// A machine without rotary axes has no transformation.
  void transform(bool on) {
    if (transforms_ == on || machine_.axes().size() == 3) return;
    line(on ? "TRAORI" : "TRAFOOF");
    transforms_ = on;
    forget();
  }

  /// Before a tool's first block, from the retracted position: turns the rotary axes before the control keeps the tip
  /// in place, then moves across. The block itself comes down.
  void come(const PostBlock& b) {
    coming_ = false;
    const auto go = [&](std::string_view letters) {
      std::string words;
      for (const char letter : letters) word(words, letter, b.joints[joint_index(letter)], true);
      if (!words.empty()) line("G0" + words), motion_ = '0';
    };
    const std::string_view axes = machine_.axes();
    go(axes.substr(3));
    transform(true);
    go("XY");
  }

  void forget() {
    printed_.fill(kNever), feed_ = kNever;
    motion_ = ' ';
  }

  void motion(const PostBlock& b, char motion, const std::string& words) {
    ++blocks_;
    std::string text;
    if (motion != motion_) text.append("G").append(1, motion_ = motion);
    text.append(words, text.empty() ? 1 : 0);
    if (!b.rapid) {
      const std::int64_t feed = std::max<std::int64_t>(1, ticks(b.feed, kFeedDecimals));
      if (feed != feed_) text += " F", put_ticks(text, feed, kFeedDecimals, true);
      feed_ = feed;
    }
    line(text);
  }

  void word(std::string& text, char letter, double value, bool always) {
    const std::size_t k = joint_index(letter);
    const int decimals = k >= 3 ? kAngleDecimals : kLengthDecimals;
    const std::int64_t print = ticks(value, decimals);
    if (print == printed_[k] && !always) return;
    printed_[k] = print;
    text.append(" ").append(1, letter);
    put_ticks(text, print, decimals);
  }

  int number_ = 0;
  bool turns_ = false, moves_ = false, coming_ = false, transforms_ = false;
  std::size_t normal_ = 2;
  std::array<std::int64_t, 6> printed_{};
  std::int64_t feed_ = kNever;
  char motion_ = ' ';
};

}  // namespace

std::unique_ptr<Post> make_sinumerik(const Machine& machine, PostOptions options) {
  return std::make_unique<Sinumerik>(machine, std::move(options));
}

}  // namespace riffler::nc
