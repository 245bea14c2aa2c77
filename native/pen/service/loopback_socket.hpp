// A TCP connection to a program on this computer.
#pragma once

#include <cstdint>
#include <span>
#include <utility>

namespace riffler::pen {

/// Connects to 127.0.0.1 only. Used by one thread at a time. Nothing here waits longer than the given time.
class LoopbackSocket {
 public:
  /// Throws OpenError: NotRunning if no program listens at the port, NoAnswer if it does not accept within `seconds`.
  LoopbackSocket(std::uint16_t port, double seconds);
  LoopbackSocket(LoopbackSocket&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  LoopbackSocket& operator=(LoopbackSocket&&) = delete;
  ~LoopbackSocket();

  /// Waits up to `seconds` (0: not at all) and reads what has arrived. Returns its size, 0 if nothing arrived, −1 if
  /// the other program has closed the connection or it is broken.
  int read(std::span<std::uint8_t> bytes, double seconds) noexcept;
  /// False if the connection is closed or broken, or if not all bytes could be sent within `seconds`.
  bool write(std::span<const std::uint8_t> bytes, double seconds) noexcept;
  /// Ends what this side sends, and waits up to `seconds` for the other program to read it and to close. Closing at
  /// once resets the connection where bytes have arrived that nothing read, and the other program may lose what it has
  /// not read yet (RFC 1122, 4.2.2.13).
  void finish(double seconds) noexcept;

 private:
  bool wait(bool to_write, double seconds) noexcept;
  std::intptr_t socket_ = -1;
};

}  // namespace riffler::pen
