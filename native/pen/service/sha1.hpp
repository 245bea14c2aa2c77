// SHA-1 and Base64, which the opening handshake of a WebSocket requires (RFC 6455, 1.3). Not for security.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace riffler::pen {

/// SHA-1 (RFC 3174).
std::array<std::uint8_t, 20> sha1(std::string_view text);

/// Base64 with padding (RFC 4648, 4).
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace riffler::pen
