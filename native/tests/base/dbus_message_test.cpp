// Messages of D-Bus: bytes of the specification, and bytes that are no message.
#include "base/dbus_message.hpp"

#include <gtest/gtest.h>

#include <random>

namespace riffler::base::dbus_message_test {
namespace {

DbusCall call() {
  DbusWriter body;
  body.u64(0x0102030405060708), body.u32(20);
  return {"a.b", "/a", "a.b.C", "Make", "tu", body.bytes()};
}

TEST(DbusMessage, EncodesAsTheSpecificationStates) {
  // Hello, as every client of a bus sends it first; by hand from the specification's rules.
  const std::string text(
      "l\1\0\1\0\0\0\0\1\0\0\0\x6d\0\0\0"
      "\1\1o\0\x15\0\0\0/org/freedesktop/DBus\0\0\0"
      "\2\1s\0\x14\0\0\0org.freedesktop.DBus\0\0\0\0"
      "\3\1s\0\5\0\0\0Hello\0\0\0"
      "\6\1s\0\x14\0\0\0org.freedesktop.DBus\0\0\0\0",
      16 + 32 + 32 + 16 + 32);
  const std::vector<std::uint8_t> bytes =
      encode({"org.freedesktop.DBus", "/org/freedesktop/DBus", "org.freedesktop.DBus", "Hello"}, 1);
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), text);
}

TEST(DbusMessage, DecodesWhatItEncodes) {
  const std::vector<std::uint8_t> bytes = encode(call(), 7);
  ASSERT_EQ(dbus_size(std::span(bytes).first(kDbusStart)), bytes.size());
  const auto message = decode(bytes);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->serial, 7U);
  EXPECT_EQ(message->path + message->interface + message->member + message->types, "/aa.b.CMaketu");
  DbusReader in(message->body);
  EXPECT_EQ(in.u64(), 0x0102030405060708U);
  EXPECT_EQ(in.u32(), 20U);
  EXPECT_FALSE(in.failed());
  in.byte();
  EXPECT_TRUE(in.failed());
}

TEST(DbusMessage, RefusesEveryTruncatedMessage) {
  const std::vector<std::uint8_t> bytes = encode(call(), 7);
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(decode(std::span(bytes).first(n))) << n;
  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_FALSE(decode(longer));
}

TEST(DbusMessage, RefusesSizesBeyondItsLimitAndOtherByteOrders) {
  std::vector<std::uint8_t> bytes = encode(call(), 7);
  const auto with = [&](std::size_t at, std::uint8_t value) {
    std::vector<std::uint8_t> out = bytes;
    out[at] = value;
    return dbus_size(out);
  };
  EXPECT_FALSE(with(0, 'B'));
  EXPECT_FALSE(with(1, 0));
  EXPECT_FALSE(with(1, 5));
  EXPECT_FALSE(with(3, 2));
  for (const std::size_t at : {6, 7, 14, 15}) EXPECT_FALSE(with(at, 0xFF)) << at;
}

/// Reads of bytes that mean nothing end, within the bytes: the sanitizers see the rest.
TEST(DbusMessage, SurvivesRandomChanges) {
  std::mt19937 random(1);
  const std::vector<std::uint8_t> bytes = encode(call(), 7);
  int refused = 0;
  for (int k = 0; k < 20000; ++k) {
    std::vector<std::uint8_t> changed = bytes;
    for (unsigned n = 1 + random() % 4; n > 0; --n)
      changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
    const auto message = decode(changed);
    refused += !message;
    if (!message) continue;
    DbusReader in(message->body);
    in.signature(), in.string(), in.u64();
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace riffler::base::dbus_message_test
