#include "pen/service/loopback_socket.hpp"

// Before windows.h, which other headers may include.
#include <winsock2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/windows/wide.hpp"
#include "pen/link/deadline.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {
namespace {

SOCKET handle(std::intptr_t socket) {
  return static_cast<SOCKET>(socket);
}

[[noreturn]] void fail_to_connect(std::uint16_t port, int error) {
  const std::string at = "127.0.0.1:" + std::to_string(port) + ": ";
  if (error == WSAECONNREFUSED) throw OpenError(OpenProblem::NotRunning, at + "no program listens");
  if (error == WSAETIMEDOUT) throw OpenError(OpenProblem::NoAnswer, at + "the connection is not accepted in time");
  throw OpenError(OpenProblem::Other, at + base::error_text(static_cast<std::uint32_t>(error)));
}

bool start_sockets() {
  WSADATA data{};
  return WSAStartup(MAKEWORD(2, 2), &data) == 0;
}

}  // namespace

LoopbackSocket::LoopbackSocket(std::uint16_t port, double seconds) {
  static const bool started = start_sockets();  // until the process ends
  if (!started) throw OpenError(OpenProblem::Other, "Windows has no sockets");
  const SOCKET made = ::socket(AF_INET, SOCK_STREAM, 0);
  if (made == INVALID_SOCKET) fail_to_connect(port, WSAGetLastError());
  socket_ = static_cast<std::intptr_t>(made);
  u_long not_blocking = 1;
  ::ioctlsocket(made, static_cast<long>(FIONBIO), &not_blocking);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  int error = ::connect(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : WSAGetLastError();
  if (error == WSAEWOULDBLOCK) {
    int size = sizeof error;
    if (!wait(true, seconds))
      error = WSAETIMEDOUT;
    else if (::getsockopt(made, SOL_SOCKET, SO_ERROR, reinterpret_cast<char*>(&error), &size) != 0)
      error = WSAGetLastError();
  }
  if (error != 0) {
    ::closesocket(handle(std::exchange(socket_, -1)));
    fail_to_connect(port, error);
  }
  const int on = 1;  // a command must not wait for the next one
  ::setsockopt(made, IPPROTO_TCP, TCP_NODELAY, reinterpret_cast<const char*>(&on), sizeof on);
}

LoopbackSocket::~LoopbackSocket() {
  if (socket_ >= 0) ::closesocket(handle(socket_));
}

bool LoopbackSocket::wait(bool to_write, double seconds) noexcept {
  // select also tells of a connection that failed; WSAPoll does so from Windows 10 of 2020 on only.
  fd_set ready{}, failed{};
  FD_SET(handle(socket_), &ready);
  FD_SET(handle(socket_), &failed);
  const double whole = std::floor(std::min(seconds, 1e6));
  const timeval limit{static_cast<long>(whole), static_cast<long>(1e6 * (std::min(seconds, 1e6) - whole))};
  return ::select(0, to_write ? nullptr : &ready, to_write ? &ready : nullptr, &failed, &limit) > 0;
}

int LoopbackSocket::read(std::span<std::uint8_t> bytes, double seconds) noexcept {
  for (bool waited = false;; waited = true) {
    const int n = ::recv(handle(socket_), reinterpret_cast<char*>(bytes.data()), static_cast<int>(bytes.size()), 0);
    if (n > 0) return n;
    if (n == 0) return bytes.empty() ? 0 : -1;
    if (WSAGetLastError() != WSAEWOULDBLOCK) return -1;
    if (waited || seconds <= 0 || !wait(false, seconds)) return 0;
  }
}

void LoopbackSocket::finish(double seconds) noexcept {
  if (::shutdown(handle(socket_), SD_SEND) != 0) return;
  std::array<std::uint8_t, 1024> rest{};
  for (const Deadline deadline(seconds); deadline.left() > 0;)
    if (read(rest, deadline.left()) < 0) return;
}

bool LoopbackSocket::write(std::span<const std::uint8_t> bytes, double seconds) noexcept {
  const Deadline deadline(seconds);
  while (!bytes.empty()) {
    const int n =
        ::send(handle(socket_), reinterpret_cast<const char*>(bytes.data()), static_cast<int>(bytes.size()), 0);
    if (n > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    } else if (n < 0) {
      if (WSAGetLastError() != WSAEWOULDBLOCK) return false;
      if (!wait(true, deadline.left())) return false;
    }
  }
  return true;
}

}  // namespace riffler::pen
