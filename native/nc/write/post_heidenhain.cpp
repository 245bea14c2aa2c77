// Heidenhain Klartext (TNC 640 user's manual, "M128" and "Three-dimensional tool compensation"): the control keeps the
// tip, either with rotary axis angles in L blocks or with the tool's axis in LN blocks.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "nc/number_text.hpp"
#include "nc/write/post.hpp"

namespace riffler::nc {

namespace {

constexpr int kVectorDecimals = 8, kFeed = 3;

class Heidenhain final : public Post {
 public:
  Heidenhain(const Machine& machine, PostOptions options) : Post(machine, std::move(options)) {
    if (machine.joint_words())
      throw std::invalid_argument("machine " + machine.name() +
                                  ": code for a Heidenhain control has tip coordinates (M128): tcp must not be False");
    if (options_.retract)
      throw std::invalid_argument("machine " + machine.name() +
                                  ": retract is G53's; put L Z+… M91 into retract of the machine's file");
  }

  bool wants_joints() const override { return !options_.vectors; }

  void begin(std::span<const std::string> comments) override {
    line("BEGIN PGM RIFFLER MM");
    for (const std::string& comment : comments) line("; " + plain(comment));
    for (const std::string& own : machine_.control().start) line(own);
  }

  void change_tool(int number, const Tool*, bool first) override {
    if (!first) {
      line("M129");
      if (turns_) line("M5");
      turns_ = false;
    }
    retract(), moves_ = true;
    tool_ = number;
  }

  void spindle(double speed) override {
    std::string call("TOOL CALL");
    if (tool_ > 0) call.append(" ").append(std::to_string(tool_)).append(" Z");
    call.append(" S").append(number_text(std::abs(speed), kFeed));
    if (tool_ > 0 || speed != 0) line(call);
    tool_ = 0;
    line(speed == 0 ? "M5" : speed > 0 ? "M3" : "M4");
    turns_ = speed != 0;
  }

  void ready(int) override {
    if (tool_ > 0) line("TOOL CALL " + std::to_string(tool_) + " Z");
    tool_ = 0;
    if (options_.coolant != "off") line(options_.coolant == "flood" ? "M8" : "M7");
    printed_.fill(kNever), feed_ = kNever, first_ = true;
    coming_ = comes_safely();
    if (!coming_) line("M128");
  }

  void block(const PostBlock& b) override {
    if (coming_) come(b);
    std::string words;
    for (const char letter : options_.vectors ? std::string_view("XYZ") : machine_.axes()) {
      const std::size_t k = joint_index(letter);
      const double value = options_.vectors ? b.pose.tip[static_cast<int>(k)] : b.joints[k];
      word(words, {&letter, 1}, value, printed_[k], k >= 3 ? kAngleDecimals : kLengthDecimals, b.must && k == 0);
    }
    bool turned = false;
    for (int k = 0; options_.vectors && k < 3; ++k)
      turned |= ticks(b.pose.axis[k], kVectorDecimals) != vector_[static_cast<std::size_t>(k)] || first_;
    if (words.empty() && !turned) return;
    for (int k = 0; options_.vectors && k < 3; ++k) {
      auto& printed = vector_[static_cast<std::size_t>(k)];
      const char name[] = {'T', "XYZ"[k]};
      word(words, {name, 2}, b.pose.axis[k], printed, kVectorDecimals, true);
    }
    ++blocks_;
    std::string text = (options_.vectors ? "LN" : "L") + words;
    if (first_) text += " R0";
    first_ = false;
    if (b.rapid) {
      text += " FMAX";
    } else if (const std::int64_t feed = std::max<std::int64_t>(1, ticks(b.feed, kFeed)); feed != feed_) {
      text += " F", feed_ = feed;
      put_ticks(text, feed, kFeed, true);
    }
    line(text);
  }

  void end() override {
    if (first_ || blocks_ > 0) line("M129");
    if (turns_) line("M5");
    if (options_.coolant != "off") line("M9");
    if (moves_) retract();
    for (const std::string& own : machine_.control().end) line(own);
    line("M30");
    line("END PGM RIFFLER MM");
  }

 private:
  void retract() {
    if (options_.safe_start)
      for (const std::string& own : machine_.control().retract) line(own);
  }

  /// Before a tool's first block, from the retracted position: turns the rotary axes before the control keeps the tip
  /// in place, then moves across. The block itself comes down.
  void come(const PostBlock& b) {
    coming_ = false;
    std::string turn;
    for (const char letter : options_.vectors ? std::string_view() : machine_.axes().substr(3)) {
      const std::size_t k = joint_index(letter);
      word(turn, {&letter, 1}, b.joints[k], printed_[k], kAngleDecimals, true);
    }
    if (!turn.empty()) line("L" + turn + " R0 FMAX"), first_ = false;
    line("M128");
    std::string across;
    for (const char letter : {'X', 'Y'}) {
      const std::size_t k = joint_index(letter);
      const double value = options_.vectors ? b.pose.tip[static_cast<int>(k)] : b.joints[k];
      word(across, {&letter, 1}, value, printed_[k], kLengthDecimals, true);
    }
    line("L" + across + (first_ ? " R0 FMAX" : " FMAX"));
  }

  void line(const std::string& text) { text_ += std::to_string(number_++) + ' ' + text + '\n'; }

  /// " X+1.00000", if it differs from the previous value or `always`.
  static void word(std::string& text, std::string_view name, double value, std::int64_t& printed, int decimals,
                   bool always) {
    const std::int64_t print = ticks(value, decimals);
    if (print == printed && !always) return;
    printed = print;
    text += ' ', text += name;
    if (print >= 0) text += '+';
    put_ticks(text, print, decimals);
  }

  int number_ = 0, tool_ = 0;
  bool turns_ = false, first_ = false, moves_ = false, coming_ = false;
  std::array<std::int64_t, 6> printed_{};
  std::array<std::int64_t, 3> vector_{};
  std::int64_t feed_ = kNever;
};

}  // namespace

std::unique_ptr<Post> make_heidenhain(const Machine& machine, PostOptions options) {
  return std::make_unique<Heidenhain>(machine, std::move(options));
}

}  // namespace riffler::nc
