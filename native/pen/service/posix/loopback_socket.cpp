#include "pen/service/loopback_socket.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "pen/link/deadline.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {
namespace {

int descriptor(std::intptr_t socket) {
  return static_cast<int>(socket);
}

[[noreturn]] void fail_to_connect(std::uint16_t port, int error) {
  const std::string at = "127.0.0.1:" + std::to_string(port) + ": ";
  if (error == ECONNREFUSED) throw OpenError(OpenProblem::NotRunning, at + "no program listens");
  if (error == ETIMEDOUT) throw OpenError(OpenProblem::NoAnswer, at + "the connection is not accepted in time");
  throw OpenError(OpenProblem::Other, at + std::strerror(error));
}

}  // namespace

LoopbackSocket::LoopbackSocket(std::uint16_t port, double seconds) {
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) fail_to_connect(port, errno);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  int error =
      ::connect(descriptor(socket_), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    socklen_t size = sizeof error;
    if (!wait(true, seconds))
      error = ETIMEDOUT;
    else if (::getsockopt(descriptor(socket_), SOL_SOCKET, SO_ERROR, &error, &size) != 0)
      error = errno;
  }
  if (error != 0) {
    ::close(static_cast<int>(std::exchange(socket_, -1)));
    fail_to_connect(port, error);
  }
  const int on = 1;  // a command must not wait for the next one
  ::setsockopt(descriptor(socket_), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

LoopbackSocket::~LoopbackSocket() {
  if (socket_ >= 0) ::close(descriptor(socket_));
}

bool LoopbackSocket::wait(bool to_write, double seconds) noexcept {
  pollfd file{descriptor(socket_), static_cast<short>(to_write ? POLLOUT : POLLIN), 0};
  const Deadline deadline(seconds);
  for (;;) {
    const double left = deadline.left();
    timespec time{};
    time.tv_sec = static_cast<time_t>(left);
    time.tv_nsec = static_cast<long>(1e9 * (left - static_cast<double>(time.tv_sec)));
    const int ready = ::ppoll(&file, 1, &time, nullptr);
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

int LoopbackSocket::read(std::span<std::uint8_t> bytes, double seconds) noexcept {
  for (bool waited = false;; waited = true) {
    const ssize_t n = ::recv(descriptor(socket_), bytes.data(), bytes.size(), 0);
    if (n > 0) return static_cast<int>(n);
    if (n == 0) return bytes.empty() ? 0 : -1;
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return -1;
    if (waited || seconds <= 0 || !wait(false, seconds)) return 0;
  }
}

void LoopbackSocket::finish(double seconds) noexcept {
  if (::shutdown(descriptor(socket_), SHUT_WR) != 0) return;
  std::array<std::uint8_t, 1024> rest{};
  for (const Deadline deadline(seconds); deadline.left() > 0;)
    if (read(rest, deadline.left()) < 0) return;
}

bool LoopbackSocket::write(std::span<const std::uint8_t> bytes, double seconds) noexcept {
  const Deadline deadline(seconds);
  while (!bytes.empty()) {
    const ssize_t n = ::send(descriptor(socket_), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    } else if (n < 0 && errno != EINTR) {
      if (errno != EAGAIN && errno != EWOULDBLOCK) return false;
      if (!wait(true, deadline.left())) return false;
    }
  }
  return true;
}

}  // namespace riffler::pen
