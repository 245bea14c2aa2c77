// The client against servers of all kinds, over the loopback.
#include "pen/service/web_socket.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pen/service/http.hpp"
#include "pen/service/web_socket_server.hpp"
#include "riffler/pen/hid/open_error.hpp"
#include "support/allocations.hpp"

namespace riffler::pen::web_socket_test {
namespace {

using test::LoopbackServer;
using test::Peer;
using test::server_frame;

/// The problem, and its text.
std::string problem_of(const std::function<void()>& open) {
  try {
    open();
  } catch (const OpenError& error) {
    return std::string(problem_text(error.problem())) + ": " + error.what();
  }
  return "none";
}

std::string text_of(WebSocket& socket, double seconds = 2) {
  std::vector<std::uint8_t> bytes(WebSocket::kLongestMessage);
  const int n = socket.read(bytes, seconds);
  return n < 0 ? "gone" : std::string(bytes.begin(), bytes.begin() + n);
}

bool send(WebSocket& socket, const std::string& text) {
  return socket.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

/// Opens the WebSocket, then does more.
LoopbackServer::Handler opening(std::function<void(Peer&, test::ClientFrames&)> then) {
  return [then](Peer& peer) {
    peer.send(test::upgrade_answer(peer.read_until("\r\n\r\n")));
    test::ClientFrames frames;
    then(peer, frames);
  };
}

std::optional<test::ClientFrames::Frame> next(Peer& peer, test::ClientFrames& frames) {
  while (peer.alive) {
    if (auto frame = frames.next()) return frame;
    frames.add(peer.read());
  }
  return std::nullopt;
}

TEST(WebSocket, EchoesThroughAServer) {
  LoopbackServer server(opening([](Peer& peer, test::ClientFrames& frames) {
    while (const auto frame = next(peer, frames))
      if (frame->opcode == 1 && frame->masked) peer.send(server_frame(frame->payload));
  }));
  WebSocket socket(server.port(), 2);
  for (const std::size_t n : {1U, 100U, 1000U, 65536U}) {
    EXPECT_TRUE(send(socket, std::string(n, 'e')));
    EXPECT_EQ(text_of(socket), std::string(n, 'e'));
  }
  EXPECT_EQ(text_of(socket, 0), "");
}

TEST(WebSocket, AnOpenOneAllocatesNothing) {
  LoopbackServer server(opening([](Peer& peer, test::ClientFrames& frames) {
    while (const auto frame = next(peer, frames))
      if (frame->opcode == 1) peer.send(server_frame("", 0x89) + server_frame(frame->payload));
  }));
  WebSocket socket(server.port(), 2);
  std::vector<std::uint8_t> bytes(1000, 'x'), answer(2000);
  const long before = test::allocations();
  int answers = 0;
  for (int k = 0; k < 200; ++k) answers += socket.write(bytes) && socket.read(answer, 2) == 1000;
  EXPECT_EQ(test::allocations(), before);
  EXPECT_EQ(answers, 200);
}

/// A client that closes while bytes of the server are unread would reset the connection, and the server would lose what
/// it has not read yet.
TEST(WebSocket, TheLastMessageArrivesThoughAnswersAreLeftUnread) {
  for (int k = 0; k < 20; ++k) {
    std::atomic<bool> last{false};
    {
      LoopbackServer server(opening([&](Peer& peer, test::ClientFrames& frames) {
        for (int n = 0; n < 50; ++n) peer.send(server_frame(std::string(1000, 's')));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        while (const auto frame = next(peer, frames)) {
          last = last || frame->payload == "stop";
          if (frame->opcode == 8) break;
        }
      }));
      WebSocket socket(server.port(), 2);
      EXPECT_EQ(text_of(socket).size(), 1000U);
      EXPECT_TRUE(send(socket, "stop"));
    }
    EXPECT_TRUE(last) << k;
  }
}

TEST(WebSocket, TheFirstMessageMayComeWithTheAnswer) {
  LoopbackServer server([](Peer& peer) {
    peer.send(test::upgrade_answer(peer.read_until("\r\n\r\n")) + server_frame("first") + server_frame("second"));
    while (peer.alive) peer.read();
  });
  WebSocket socket(server.port(), 2);
  EXPECT_EQ(text_of(socket), "first");
  EXPECT_EQ(text_of(socket), "second");
}

TEST(WebSocket, AnswersPingsAndReportsThatItCloses) {
  std::atomic<int> pongs{0}, closes{0};
  {
    LoopbackServer server(opening([&](Peer& peer, test::ClientFrames& frames) {
      peer.send(server_frame("are you there", 0x89) + server_frame("text"));
      while (const auto frame = next(peer, frames)) {
        pongs += frame->opcode == 10 && frame->payload == "are you there";
        closes += frame->opcode == 8 && frame->payload == std::string("\x03\xE8", 2);
        if (frame->opcode == 8) break;
      }
    }));
    {
      WebSocket socket(server.port(), 2);
      EXPECT_EQ(text_of(socket), "text");
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (closes == 0 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  }
  EXPECT_EQ(pongs, 1);
  EXPECT_EQ(closes, 1);
}

TEST(WebSocket, AServerThatClosesBreaksOffOrBreaksTheRulesIsGone) {
  for (const std::string& last : {server_frame("", 0x88), std::string(), std::string("\xFF\xFF"),
                                  server_frame("x", 0x82), server_frame(std::string(70'000, 'x'))}) {
    LoopbackServer server(opening([&](Peer& peer, test::ClientFrames&) { peer.send(server_frame("a") + last); }));
    WebSocket socket(server.port(), 2);
    EXPECT_EQ(text_of(socket), "a");
    EXPECT_EQ(text_of(socket), "gone");
    EXPECT_EQ(text_of(socket), "gone");
    EXPECT_FALSE(send(socket, "b"));
  }
}

TEST(WebSocket, AMessageThatTheBufferCannotHoldEndsTheConnection) {
  LoopbackServer server(opening([](Peer& peer, test::ClientFrames&) {
    peer.send(server_frame("twelve bytes"));
    while (peer.alive) peer.read();
  }));
  WebSocket socket(server.port(), 2);
  std::vector<std::uint8_t> bytes(11);
  EXPECT_EQ(socket.read(bytes, 2), -1);
}

TEST(WebSocket, AServerThatDoesNotReadIsGoneInTime) {
  LoopbackServer server(opening([](Peer& peer, test::ClientFrames&) {
    for (int k = 0; k < 100 && peer.alive; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }));
  WebSocket socket(server.port(), 2);
  const auto start = std::chrono::steady_clock::now();
  int sent = 0;
  while (send(socket, std::string(60'000, 'x')) && sent < 10'000) ++sent;
  EXPECT_LT(sent, 10'000);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(1500));
}

TEST(WebSocket, OtherServersAreRefusedWithTheReason) {
  const auto answer = [](const std::string& text) {
    LoopbackServer server([&](Peer& peer) {
      peer.read_until("\r\n\r\n");
      peer.send(text);
    });
    return problem_of([&] { WebSocket(server.port(), 0.3); });
  };
  const std::string head = "HTTP/1.1 101 Switching Protocols\r\n", up = "Upgrade: websocket\r\nConnection: Upgrade\r\n";
  EXPECT_EQ(answer(""), "no answer: it closes the connection");
  EXPECT_EQ(answer("SSH-2.0-OpenSSH_9.2\r\n\r\n"),
            "contradicts itself: its answer is not HTTP: the status line is not that of HTTP/1.1");
  EXPECT_EQ(answer(std::string(20'000, 'x')), "contradicts itself: its answer is not an HTTP head");
  EXPECT_EQ(answer("HTTP/1.1 404 Not Found\r\n\r\n"), "contradicts itself: it opens no WebSocket: status 404");
  EXPECT_EQ(answer(head + "Upgrade: h2c\r\nConnection: Upgrade\r\n\r\n"),
            "contradicts itself: it upgrades the connection to something other than a WebSocket");
  EXPECT_EQ(answer(head + up + "Sec-WebSocket-Accept: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"),
            "contradicts itself: it answers with a wrong key");
  EXPECT_EQ(answer(head + up + "\r\n"), "contradicts itself: it answers with a wrong key");
  LoopbackServer extended([](Peer& peer) {
    std::string text = test::upgrade_answer(peer.read_until("\r\n\r\n"));
    peer.send(text.insert(text.size() - 2, "Sec-WebSocket-Extensions: permessage-deflate\r\n"));
  });
  EXPECT_EQ(problem_of([&] { WebSocket(extended.port(), 0.3); }),
            "contradicts itself: it uses sec-websocket-extensions, which was not asked for");
}

TEST(WebSocket, AMuteServerAndAClosedPortAreDistinguished) {
  LoopbackServer mute([](Peer& peer) {
    while (peer.alive) peer.read();
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(problem_of([&] { WebSocket(mute.port(), 0.1); }), "no answer: it does not answer");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
  const std::uint16_t port = test::closed_port();
  EXPECT_EQ(problem_of([&] { WebSocket(port, 0.1); }),
            "not running: 127.0.0.1:" + std::to_string(port) + ": no program listens");
}

TEST(Http, GetsABodyByItsLengthOrUntilTheEnd) {
  const auto get = [](const std::string& text) {
    LoopbackServer server([&](Peer& peer) {
      peer.read_until("\r\n\r\n");
      peer.send(text);
    });
    std::string body;
    const std::string problem = problem_of([&] { body = http_get(server.port(), "/version", 0.5); });
    return problem == "none" ? body : problem;
  };
  EXPECT_EQ(get("HTTP/1.1 200 OK\r\nContent-Length: 4\r\n\r\nbodyand more"), "body");
  EXPECT_EQ(get("HTTP/1.0 200 OK\r\n\r\nall of it"), "all of it");
  EXPECT_EQ(get("HTTP/1.1 200 OK\r\ncontent-length:  2 \r\n\r\n{}"), "{}");
  EXPECT_EQ(get("HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\nbody"), "no answer: its answer is incomplete");
  EXPECT_EQ(get("HTTP/1.1 200 OK\r\nContent-Length: -1\r\n\r\nbody"),
            "contradicts itself: the length of its answer makes no sense");
  EXPECT_EQ(get("HTTP/1.1 503 Busy\r\n\r\n"), "contradicts itself: it answers /version with status 503");
  EXPECT_EQ(get("HTTP/1.1 200 OK\r\n\r\n" + std::string(100'000, 'x')), "contradicts itself: its answer is too long");
}

TEST(Http, HeadsAreReadStrictly) {
  const HttpHead head = parse_http_head("HTTP/1.1 200 OK\r\nA: 1\r\nb-C:\t two words \r\nA: 2\r\n\r\n");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.field("b-c"), "two words");
  EXPECT_EQ(head.field("a"), "") << "there are two";
  EXPECT_EQ(head.field("d"), "");
  for (const char* text :
       {"", "HTTP/1.1 200 OK", "HTTP/1.1 200 OK\r\n", "HTTP/2 200\r\n\r\n", "HTTP/1.1 2x0 OK\r\n\r\n",
        "HTTP/1.1 099\r\n\r\n", "HTTP/1.1 2000\r\n\r\n", "HTTP/1.1 200 OK\r\nno colon\r\n\r\n",
        "HTTP/1.1 200 OK\r\n: no name\r\n\r\n", "HTTP/1.1 200 OK\r\nA : 1\r\n\r\n",
        "HTTP/1.1 200 OK\r\n folded: 1\r\n\r\n", "HTTP/1.1 200 OK\r\n\r\nmore"})
    EXPECT_THROW(parse_http_head(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace riffler::pen::web_socket_test
