#include "pen/service/frame_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "pen/service/sha1.hpp"
#include "pen/service/web_socket_server.hpp"
#include "stress/random.hpp"

namespace riffler::pen::frame_reader_test {
namespace {

using test::server_frame;
using Event = FrameReader::Event;

/// The events of some bytes, given in pieces of a size: a letter each, and messages in brackets.
std::string events(const std::string& bytes, std::size_t piece = 1'000'000, std::size_t longest = 70'000) {
  FrameReader reader(longest);
  std::string out;
  std::size_t at = 0;
  for (;;) {
    const Event event = reader.next();
    const auto payload = reader.payload();
    const std::string text(payload.begin(), payload.end());
    if (event == Event::Message) out += "[" + (text.size() > 40 ? std::to_string(text.size()) : text) + "]";
    if (event == Event::Ping) out += "?" + text;
    if (event == Event::Close) return out + "C";
    if (event == Event::Bad) return out + "!";
    if (event != Event::More) continue;
    if (at == bytes.size()) return out;
    const auto space = reader.space();
    const std::size_t n = std::min({piece, bytes.size() - at, space.size()});
    EXPECT_GT(n, 0U);
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), n, space.begin());
    reader.received(n);
    at += n;
  }
}

TEST(FrameReader, ReadsMessagesOfAllLengths) {
  for (const std::size_t n : {0U, 1U, 125U, 126U, 127U, 65535U, 65536U, 70'000U}) {
    const std::string frame = server_frame(std::string(n, 'x')) + server_frame("end");
    const std::string expected = "[" + (n > 40 ? std::to_string(n) : std::string(n, 'x')) + "][end]";
    EXPECT_EQ(events(frame), expected) << n;
    if (n < 200) {
      EXPECT_EQ(events(frame, 1), expected) << n;
    }
  }
}

TEST(FrameReader, FragmentsMakeOneMessageAndPingsMayComeBetween) {
  const std::string bytes =
      server_frame("a", 0x01) + server_frame("hi", 0x89) + server_frame("b", 0x00) + server_frame("c", 0x80);
  EXPECT_EQ(events(bytes), "?hi[abc]");
  EXPECT_EQ(events(bytes, 1), "?hi[abc]");
  EXPECT_EQ(events(server_frame("x", 0x8A) + server_frame("y")), "[y]") << "a pong means nothing";
}

TEST(FrameReader, NothingFollowsAClose) {
  EXPECT_EQ(events(server_frame("a") + server_frame("", 0x88) + server_frame("b")), "[a]C");
}

TEST(FrameReader, FramesThatAServerMayNotSendAreBad) {
  EXPECT_EQ(events(server_frame("a", 0xC1)), "!") << "a reserved bit";
  EXPECT_EQ(events(server_frame("a", 0x82)), "!") << "binary";
  EXPECT_EQ(events(server_frame("a", 0x83)), "!") << "a reserved kind";
  EXPECT_EQ(events(server_frame("a", 0x8B)), "!");
  EXPECT_EQ(events(server_frame("a", 0x80)), "!") << "a continuation of nothing";
  EXPECT_EQ(events(server_frame("a", 0x01) + server_frame("b")), "!") << "a new message within one";
  EXPECT_EQ(events(server_frame("a", 0x09)), "!") << "a ping in pieces";
  EXPECT_EQ(events(server_frame(std::string(126, 'p'), 0x89)), "!") << "a long ping";
  EXPECT_EQ(events(std::string("\x81\x81", 2) + "abcd?"), "!") << "masked";
  EXPECT_EQ(events(std::string("\x81\x7E\x00\x05hello", 9)), "!") << "a length that could be shorter";
  EXPECT_EQ(events(std::string("\x81\x7F\x00\x00\x00\x00\x00\x00\x00\x05hello", 15)), "!");
  EXPECT_EQ(events(std::string("\x81\x7F\x80\x00\x00\x00\x00\x00\x00\x05", 10)), "!") << "64 bits";
}

TEST(FrameReader, MessagesAreBounded) {
  EXPECT_EQ(events(server_frame(std::string(101, 'x')), 1'000'000, 100), "!");
  EXPECT_EQ(events(server_frame(std::string(100, 'x')), 1'000'000, 100), "[100]");
  EXPECT_EQ(events(server_frame(std::string(60, 'x'), 0x01) + server_frame(std::string(60, 'x'), 0x80), 1'000, 100),
            "!");
  EXPECT_EQ(events(std::string("\x81\x7F\x00\x00\x00\x01\x00\x00\x00\x00", 10)), "!") << "4 GB, refused by its head";
}

TEST(FrameReader, SurvivesAnyBytesInAnyPieces) {
  stress::Random random(8);
  for (int k = 0; k < 20'000; ++k) {
    std::string bytes;
    for (int frames = static_cast<int>(random.uniform() * 4); frames-- > 0;)
      bytes += server_frame(std::string(static_cast<std::size_t>(random.uniform() * 300), 'a'),
                            random.uniform() < 0.8 ? 0x81 : static_cast<int>(random.uniform() * 256));
    for (int damage = static_cast<int>(random.uniform() * 3); damage-- > 0 && !bytes.empty();)
      bytes[static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size()))] =
          static_cast<char>(random.uniform() * 256);
    EXPECT_EQ(events(bytes, 1 + static_cast<std::size_t>(random.uniform() * 50), 500), events(bytes, 1'000'000, 500));
  }
}

TEST(FrameReader, AClientsFramesAreMasked) {
  for (const std::size_t n : {0U, 5U, 125U, 126U, 65536U}) {
    const std::vector<std::uint8_t> payload(n, 'q');
    std::vector<std::uint8_t> out(n + kLongestFrameHead);
    const std::size_t size = write_frame(Opcode::Text, payload, {1, 2, 3, 4}, out);
    test::ClientFrames frames;
    frames.add(std::string(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(size)));
    const auto frame = frames.next();
    ASSERT_TRUE(frame) << n;
    EXPECT_EQ(frame->opcode, 1);
    EXPECT_TRUE(frame->masked);
    EXPECT_EQ(frame->payload, std::string(n, 'q'));
    EXPECT_FALSE(frames.next());
  }
}

/// The examples of RFC 3174 (7.3), RFC 4648 (10) and RFC 6455 (1.3).
TEST(Sha1, IsThatOfTheStandards) {
  const auto hex = [](const std::string& text) {
    std::string out;
    for (const std::uint8_t b : sha1(text)) out += {"0123456789abcdef"[b >> 4], "0123456789abcdef"[b & 15]};
    return out;
  };
  EXPECT_EQ(hex("abc"), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_EQ(hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "84983e441c3bd26ebaae4aa1f95129e5e54670f1");
  EXPECT_EQ(hex(std::string(1'000'000, 'a')), "34aa973cd4c4daa4f61eeb2bdbad27316534016f");
  const auto encoded = [](const std::string& text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(sha1("dGhlIHNhbXBsZSBub25jZQ==258EAFA5-E914-47DA-95CA-C5AB0DC85B11")),
            "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
}

}  // namespace
}  // namespace riffler::pen::frame_reader_test
