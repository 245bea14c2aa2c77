// A WebSocket (RFC 6455) to a service on this computer: a client without extensions, for text messages.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pen/link/transport.hpp"
#include "pen/service/frame_reader.hpp"
#include "pen/service/loopback_socket.hpp"

namespace riffler::pen {

class WebSocket final : public Transport {
 public:
  static constexpr std::size_t kLongestMessage = 65536;  // bytes, in both directions

  /// Opens ws://127.0.0.1:port/. Throws OpenError: as LoopbackSocket; NoAnswer; BadContent if what listens there is no
  /// WebSocket, or answers with a wrong key, a protocol or an extension that was not asked for.
  WebSocket(std::uint16_t port, double seconds);
  /// Tells the service that the connection ends; does not wait for its answer.
  ~WebSocket() override;

  /// A whole text message. −1 also if the service breaks the protocol or sends a message that `bytes` cannot hold.
  /// Pings are answered.
  int read(std::span<std::uint8_t> bytes, double seconds) noexcept override;
  /// Sends a text message. Waits at most 10 ms for a service that does not read.
  bool write(std::span<const std::uint8_t> bytes) noexcept override;

 private:
  void handshake(std::uint16_t port, double seconds);
  bool send(Opcode opcode, std::span<const std::uint8_t> payload) noexcept;
  void close(std::uint16_t code) noexcept;
  std::array<std::uint8_t, 4> next_mask() noexcept;

  LoopbackSocket socket_;
  FrameReader reader_;
  std::vector<std::uint8_t> out_;
  std::uint64_t mask_;  // state of a generator; a mask protects proxies, and there is none on this computer
  bool open_ = false;
};

}  // namespace riffler::pen
