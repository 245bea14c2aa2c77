// The HID report descriptor, read as an operating system reads it (Device Class Definition for HID 1.11, 6.2.2).
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "device/fields.hpp"

namespace riffler::device::descriptor_test {
namespace {

struct Item {
  int report;
  unsigned tag;        // 8 input, 9 output, 11 feature
  std::size_t offset;  // bytes from the report's number
  std::uint32_t size, count;
  std::int64_t minimum, maximum;
  std::uint32_t usage, flags;
};

struct Descriptor {
  std::vector<Item> items;
  std::uint32_t page = 0, usage = 0;
  int collections = 0;
};

/// Throws where a strict parser would refuse the descriptor.
Descriptor parse(const std::uint8_t* bytes, std::size_t size) {
  Descriptor out;
  std::map<std::pair<int, unsigned>, std::size_t> bits;
  std::set<std::uint32_t> usages;
  std::int64_t minimum = 0, maximum = 0;
  std::uint32_t report_size = 0, report_count = 0, usage = 0;
  int report = 0, depth = 0;
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::runtime_error(what);
  };
  for (std::size_t at = 0; at < size;) {
    const unsigned prefix = bytes[at++], tag = prefix >> 4, type = prefix >> 2 & 3;
    require(prefix != 0xFE, "a long item");
    const std::size_t length = (prefix & 3) == 3 ? 4 : prefix & 3;
    require(at + length <= size, "an item beyond the end");
    std::uint32_t raw = 0;
    for (std::size_t k = 0; k < length; ++k) raw |= std::uint32_t{bytes[at + k]} << (8 * k);
    // Every value is read as signed, as the strictest parsers do.
    const std::int64_t value = length == 1   ? static_cast<std::int8_t>(raw)
                               : length == 2 ? static_cast<std::int16_t>(raw)
                                             : static_cast<std::int32_t>(raw);
    at += length;
    if (type == 1) {  // global
      if (tag == 0) out.page = raw;
      if (tag == 1) minimum = value;
      if (tag == 2) maximum = value;
      if (tag == 7) report_size = raw;
      if (tag == 8) require((report = static_cast<int>(raw)) != 0, "report number 0");
      if (tag == 9) report_count = raw;
      require(tag <= 2 || (tag >= 7 && tag <= 9), "an item that this descriptor does not need");
    } else if (type == 2) {  // local
      require(tag == 0, "a local item other than a usage");
      usage = raw;
    } else if (tag == 10) {
      require(depth == 0 && raw == 1, "a collection that is not the application's");
      ++depth;
      ++out.collections;
      out.usage = usage;
      usage = 0;
    } else if (tag == 12) {
      --depth;
    } else {
      require(type == 0 && (tag == 8 || tag == 9 || tag == 11), "an unknown item");
      require(depth == 1, "a field outside the collection");
      require(report_size > 0 && report_size <= 32 && report_count > 0, "a size or count out of range");
      require(minimum < maximum, "a range that is empty where maxima are signed");
      require(usage == 0 || usages.insert(usage).second, "a usage twice");
      std::size_t& used = bits.try_emplace({report, tag}, 8).first->second;  // behind the number
      require(used % 8 == 0, "a field that begins within a byte");
      out.items.push_back({report, tag, used / 8, report_size, report_count, minimum, maximum, usage, raw});
      used += std::size_t{report_size} * report_count;
      usage = 0;
    }
  }
  require(depth == 0 && out.collections == 1, "not one collection with its end");
  return out;
}

Descriptor shipped() {
  return parse(riffler_pen_descriptor, riffler_pen_descriptor_size);
}

TEST(PenDescriptor, IsOneApplicationOfAVendor) {
  const Descriptor descriptor = shipped();
  EXPECT_EQ(descriptor.collections, 1);
  EXPECT_EQ(descriptor.page, std::uint32_t{RIFFLER_PEN_USAGE_PAGE});
  EXPECT_GE(descriptor.page, 0xFF00U) << "pages below are the standard's, and a system would act on them";
  EXPECT_EQ(descriptor.usage, std::uint32_t{RIFFLER_PEN_USAGE});
}

TEST(PenDescriptor, HasTheCodecsFieldsAtTheCodecsOffsets) {
  const Descriptor descriptor = shipped();
  std::size_t next = 0;
  for (const Report& report : reports()) {
    const unsigned tag = report.name == "Input" ? 8 : report.name == "Output" ? 9 : 11;
    std::size_t end = 1;
    for (const Field& field : report.fields) {
      ASSERT_LT(next, descriptor.items.size());
      const Item& item = descriptor.items[next++];
      SCOPED_TRACE(report.name + " " + field.name);
      EXPECT_EQ(item.report, report.id);
      EXPECT_EQ(item.tag, tag);
      EXPECT_EQ(item.offset, field.offset);
      EXPECT_EQ(item.size * item.count, 8 * field.size());
      const bool reserved = field.name == "reserved";
      EXPECT_EQ(item.flags, reserved ? 3U : 2U) << "data or constant, variable, absolute";
      EXPECT_EQ(item.usage == 0, reserved) << "what is reserved has no usage";
      // 32 unsigned bits are four bytes: no signed maximum holds them.
      const bool as_bytes = field.type == "u32" || field.type == "char";
      EXPECT_EQ(item.size, as_bytes ? 8U : 8 * field.width());
      const std::int64_t range = std::int64_t{1} << item.size;
      const bool has_sign = field.type.starts_with('i');
      EXPECT_EQ(item.minimum, has_sign ? -range / 2 : 0);
      EXPECT_EQ(item.maximum, has_sign ? range / 2 - 1 : range - 1);
      end = item.offset + item.size * item.count / 8;
    }
    EXPECT_EQ(end, report.size) << report.name;
  }
  EXPECT_EQ(next, descriptor.items.size()) << "fields that no report has";
}

TEST(PenDescriptor, TheParserDetectsErrors) {
  const std::vector<std::uint8_t> good(riffler_pen_descriptor, riffler_pen_descriptor + riffler_pen_descriptor_size);
  for (std::size_t size = 1; size < good.size(); ++size)
    EXPECT_ANY_THROW(parse(good.data(), size)) << "cut after " << size << " bytes";
}

}  // namespace
}  // namespace riffler::device::descriptor_test
