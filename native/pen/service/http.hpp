// The little of HTTP that a service on this computer needs: one GET, and the head of an answer.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pen/service/loopback_socket.hpp"

namespace riffler::pen {

inline constexpr std::size_t kLongestHead = 8192;   // bytes of status line and fields
inline constexpr std::size_t kLongestBody = 65536;  // bytes

/// Status line and fields of an answer.
struct HttpHead {
  int status = 0;
  std::vector<std::pair<std::string, std::string>> fields;  // names in lower case, values trimmed

  /// The value of the only field of that name (lower case); empty if there is none or several.
  std::string_view field(std::string_view name) const;
};

/// Parses a head that ends with an empty line (RFC 9112, 4 and 5). Throws std::invalid_argument.
HttpHead parse_http_head(std::string_view text);

/// Reads bytes until the end of the head; `rest` gets what follows it. Throws OpenError: NoAnswer after `seconds` or if
/// the connection ends, BadContent if it is longer than kLongestHead or no head of HTTP.
HttpHead read_http_head(LoopbackSocket& socket, double seconds, std::string& rest);

/// GET http://127.0.0.1:port/path; returns the body of an answer with status 200. Throws OpenError, also for other
/// statuses.
std::string http_get(std::uint16_t port, const std::string& path, double seconds);

}  // namespace riffler::pen
