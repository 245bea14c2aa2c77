#include "pen/hid/hid_descriptor.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace riffler::pen {
namespace {

/// Type and tag of a short item (6.2.2.2), the upper six bits of its first byte.
enum Item : std::uint8_t {
  kInput = 0x80,
  kOutput = 0x90,
  kCollection = 0xA0,
  kFeature = 0xB0,
  kEndCollection = 0xC0,
  kUsagePage = 0x04,
  kReportSize = 0x74,
  kReportId = 0x84,
  kReportCount = 0x94,
  kPush = 0xA4,
  kPop = 0xB4,
  kUsage = 0x08,
};
constexpr std::uint8_t kLongItem = 0xFE;
constexpr std::uint64_t kMaxBits = 8 * 4096;  // per report: Linux's HID_MAX_BUFFER_SIZE was 4096 for years

struct Globals {
  std::uint32_t page = 0, size = 0, id = 0, count = 0;
};

class Parser {
 public:
  HidReports parse(std::span<const std::uint8_t> bytes) {
    while (at_ < bytes.size()) {
      const std::uint8_t prefix = bytes[at_];
      const std::size_t head = prefix == kLongItem ? 3 : 1;
      std::size_t size = (prefix & 3) == 3 ? 4 : prefix & 3;
      if (prefix == kLongItem && at_ + 1 < bytes.size()) size = bytes[at_ + 1];
      if (at_ + head + size > bytes.size()) fail("ends within an item");
      if (prefix != kLongItem) take(prefix & 0xFC, value(bytes.subspan(at_ + 1, size)), size);
      at_ += head + size;
    }
    finish();
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument("report descriptor, byte " + std::to_string(at_) + ": " + what);
  }

  static std::uint32_t value(std::span<const std::uint8_t> bytes) {
    std::uint32_t out = 0;
    for (std::size_t k = 0; k < bytes.size(); ++k) out |= static_cast<std::uint32_t>(bytes[k]) << (8 * k);
    return out;
  }

  void take(std::uint8_t item, std::uint32_t value, std::size_t size) {
    switch (item) {
      case kInput:
        return add(input_);
      case kOutput:
        return add(output_);
      case kFeature:
        return add(feature_);
      case kCollection:
        if (depth_++ == 0) out_.usages.emplace_back(usage_ >> 16, usage_ & 0xFFFF);
        usage_ = 0;
        return;
      case kEndCollection:
        if (depth_-- == 0) fail("ends a collection that did not begin");
        return;
      case kUsage:  // a four-byte usage includes its page
        if (usage_ == 0) usage_ = size == 4 ? value : now_.page << 16 | value;
        return;
      case kUsagePage:
        now_.page = value;
        return;
      case kReportSize:
        now_.size = value;
        return;
      case kReportCount:
        now_.count = value;
        return;
      case kReportId:
        if (value == 0 || value > 255) fail("report numbers must be 1 to 255");
        now_.id = value;
        out_.numbered = true;
        return;
      case kPush:
        if (stack_.size() >= 64) fail("pushes without end");
        stack_.push_back(now_);
        return;
      case kPop:
        if (stack_.empty()) fail("pops more than it pushes");
        now_ = stack_.back();
        stack_.pop_back();
        return;
      default:
        return;
    }
  }

  void add(std::array<std::uint64_t, 256>& bits) {
    usage_ = 0;
    bits[now_.id] += static_cast<std::uint64_t>(now_.size) * now_.count;
    if (bits[now_.id] > kMaxBits) fail("a report that is too long");
  }

  void finish() {
    for (std::size_t id = 0; id < 256; ++id) {
      out_.input[id] = static_cast<std::uint16_t>((input_[id] + 7) / 8);
      out_.output[id] = static_cast<std::uint16_t>((output_[id] + 7) / 8);
      out_.feature[id] = static_cast<std::uint16_t>((feature_[id] + 7) / 8);
    }
  }

  HidReports out_;
  std::array<std::uint64_t, 256> input_{}, output_{}, feature_{};  // bits
  std::vector<Globals> stack_;
  Globals now_;
  std::uint32_t usage_ = 0;
  std::size_t depth_ = 0, at_ = 0;
};

}  // namespace

bool HidReports::has_usage(std::uint16_t page, std::uint16_t usage) const {
  return std::find(usages.begin(), usages.end(), std::pair{page, usage}) != usages.end();
}

HidReports parse_descriptor(std::span<const std::uint8_t> bytes) {
  return Parser().parse(bytes);
}

}  // namespace riffler::pen
