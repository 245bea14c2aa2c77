// APT CL file (ISO 4343): tip and axis of every row, for another system's post-processor.
#include <cmath>
#include <optional>
#include <string>

#include "geom/math.hpp"
#include "nc/apt_cutter.hpp"
#include "nc/number_text.hpp"
#include "nc/write/post.hpp"

namespace riffler::nc {

namespace {

class Apt final : public Post {
 public:
  using Post::Post;

  bool wants_joints() const override { return false; }

  void begin(std::span<const std::string> comments) override {
    line("PARTNO RIFFLER");
    for (const std::string& comment : comments) line("$$ " + plain(comment));
    line("UNITS/MM");
    line("MULTAX/ON");
  }

  void change_tool(int number, const Tool* shape, bool first) override {
    if (!first && turns_) spindle(0);
    if (number > 0) line("LOADTL/" + std::to_string(number));
    if (shape) cutter(*shape);
    feed_ = kNever;
  }

  void spindle(double speed) override {
    turns_ = speed != 0;
    line(speed == 0 ? "SPINDL/OFF" : "SPINDL/" + number_text(std::abs(speed)) + ",RPM," + (speed > 0 ? "CLW" : "CCLW"));
  }

  void ready(int) override {
    if (options_.coolant != "off") line(options_.coolant == "flood" ? "COOLNT/FLOOD" : "COOLNT/MIST");
  }

  void block(const PostBlock& b) override {
    ++blocks_;
    if (b.rapid) {
      line("RAPID");
    } else if (const std::int64_t feed = std::max<std::int64_t>(1, ticks(b.feed, kFeedDecimals)); feed != feed_) {
      std::string text = "FEDRAT/";
      put_ticks(text, feed, kFeedDecimals, true);
      line(text + ",MMPM");
      feed_ = feed;
    }
    std::string text = "GOTO/";
    for (int k = 0; k < 3; ++k) {
      put_ticks(text, ticks(b.pose.tip[k], kLengthDecimals), kLengthDecimals);
      text += ',';
    }
    for (int k = 0; k < 3; ++k) {
      put_ticks(text, ticks(b.pose.axis[k], kAxisDecimals), kAxisDecimals);
      if (k < 2) text += ',';
    }
    line(text);
  }

  void end() override {
    if (turns_) line("SPINDL/OFF");
    if (options_.coolant != "off") line("COOLNT/OFF");
    line("END");
    line("FINI");
  }

 private:
  static constexpr int kAxisDecimals = 9;

  void line(const std::string& text) { text_ += text + '\n'; }

  /// A comment if seven numbers cannot describe the shape.
  void cutter(const Tool& tool) {
    const std::optional<tool::AptCutter> apt = to_apt(tool);
    if (!apt) return line("$$ no CUTTER says " + plain(tool.kind()));
    std::string text = "CUTTER/" + number_text(apt->d);
    for (const double number : {apt->r, apt->e, apt->f, apt->a * kRadian, apt->b * kRadian, apt->h})
      text += ',', text += number_text(number);
    line(text);
  }

  std::int64_t feed_ = kNever;
  bool turns_ = false;
};

}  // namespace

std::unique_ptr<Post> make_apt(const Machine& machine, PostOptions options) {
  return std::make_unique<Apt>(machine, std::move(options));
}

}  // namespace riffler::nc
