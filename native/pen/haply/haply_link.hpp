// The connection to Haply's Inverse Service on this computer.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pen/haply/haply_message.hpp"
#include "pen/service/web_socket.hpp"

namespace riffler::pen {

/// One command in a millisecond: the service answers each command at once, and would be asked ten thousand times a
/// second.
class HaplyLink final : public Transport {
 public:
  static constexpr double kPeriod = 1e-3;  // s

  explicit HaplyLink(std::unique_ptr<WebSocket> socket) : socket_(std::move(socket)) {}
  /// Waits until a period has passed since the last command, if it may wait that long.
  int read(std::span<std::uint8_t> bytes, double seconds) noexcept override;
  bool write(std::span<const std::uint8_t> bytes) noexcept override;

 private:
  std::unique_ptr<WebSocket> socket_;
  std::chrono::steady_clock::time_point written_{};
};

/// An open connection, and what the service has sent first.
struct HaplyConnection {
  std::unique_ptr<WebSocket> socket;
  HaplyVersion version;
  std::vector<std::uint8_t> text;  // of the inventory, which refers to it
  HaplyMessage inventory;
};

/// The service's port: 10001, or RIFFLER_HAPLY_PORT if the service was configured for another one. Throws OpenError if
/// that is no port.
std::uint16_t haply_port();

/// Asks for the version and the devices. Commands nothing. Throws OpenError with the reason and the remedy.
HaplyConnection connect_haply(std::uint16_t port);

}  // namespace riffler::pen
