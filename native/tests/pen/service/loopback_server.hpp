// A program on this computer that listens on a port, for tests: a thread for each connection.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <stdexcept>
#include <string>
#include <thread>

namespace riffler::test {

/// One end of a connection.
class Peer {
 public:
  Peer(int fd, const std::atomic<bool>& stopping) : fd_(fd), stopping_(stopping) {}
  /// Bytes that have arrived within 20 ms; `alive` becomes false at the end of the connection or of the server.
  std::string read() {
    pollfd file{fd_, POLLIN, 0};
    if (stopping_) alive = false;
    if (!alive || ::poll(&file, 1, 20) <= 0) return {};
    char bytes[4096];
    const ssize_t n = ::recv(fd_, bytes, sizeof bytes, 0);
    if (n <= 0) alive = false;
    return n <= 0 ? std::string() : std::string(bytes, static_cast<std::size_t>(n));
  }
  /// Everything up to and including `end`.
  std::string read_until(const std::string& end) {
    std::string text;
    while (alive && text.find(end) == text.npos) text += read();
    return text;
  }
  void send(const std::string& bytes) {
    std::size_t at = 0;
    while (alive && at < bytes.size()) {
      const ssize_t n = ::send(fd_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (n <= 0) alive = false;
      at += n > 0 ? static_cast<std::size_t>(n) : 0;
    }
  }
  bool alive = true;

 private:
  int fd_;
  const std::atomic<bool>& stopping_;
};

class LoopbackServer {
 public:
  using Handler = std::function<void(Peer&)>;

  /// `port`: 0 chooses a free one.
  explicit LoopbackServer(Handler handler, std::uint16_t port = 0) : handler_(std::move(handler)) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int on = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener_, 16) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error("the test's server cannot listen");
    port_ = ntohs(address.sin_port);
    accepting_ = std::thread([this] { accept(); });
  }
  ~LoopbackServer() {
    stopping_ = true;
    accepting_.join();
    for (std::thread& thread : connections_) thread.join();
    ::close(listener_);
  }
  LoopbackServer(const LoopbackServer&) = delete;
  LoopbackServer& operator=(const LoopbackServer&) = delete;

  std::uint16_t port() const { return port_; }

 private:
  void accept() {
    while (!stopping_) {
      pollfd file{listener_, POLLIN, 0};
      if (::poll(&file, 1, 10) <= 0) continue;
      const int fd = ::accept(listener_, nullptr, nullptr);
      if (fd < 0) continue;
      connections_.emplace_back([this, fd] {
        Peer peer(fd, stopping_);
        handler_(peer);
        ::close(fd);
      });
    }
  }

  Handler handler_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> stopping_{false};
  std::thread accepting_;
  std::list<std::thread> connections_;
};

/// A port at which nothing listens.
inline std::uint16_t closed_port() {
  return LoopbackServer([](Peer&) {}).port();
}

}  // namespace riffler::test
