// The connection to a device as seen by other threads.
#pragma once

#include <cstdint>

#include "riffler/haptics/wrench.hpp"
#include "riffler/pen/hid/open_error.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::pen {

/// State of the connection to a device.
enum class LinkState : unsigned char {
  Stopped,     // pushing stopped, device closed
  Connected,   // reports arrive
  Waiting,     // device disconnected; the next attempt follows after a pause
  Connecting,  // searching for the device and opening it
};
/// The state as a short text for users.
const char* link_text(LinkState state) noexcept;

/// Counts since the start.
struct LinkCounts {
  std::uint64_t ticks = 0;       // ticks with an open device
  std::uint64_t reports = 0;     // reports read and decoded
  std::uint64_t superseded = 0;  // of these: replaced by a newer report before a step used them
  std::uint64_t lost = 0;        // sent (by sequence number) but not received
  std::uint64_t old = 0;         // duplicate or late
  std::uint64_t malformed = 0;   // invalid reports
  std::uint64_t timeouts = 0;    // ticks without a report
  std::uint64_t writes = 0;      // reports sent
  std::uint32_t read_errors = 0, write_errors = 0, silences = 0;  // each ended a connection
  std::uint32_t connections = 0, attempts = 0;
};

/// The state that other threads see. Trivially copyable.
struct LinkStatus {
  LinkState state = LinkState::Waiting;
  OpenProblem problem = OpenProblem::None;  // problem of the last attempt to connect
  PenSample sample{};                       // the newest sample; kept after a disconnect
  Wrench wrench{};                          // wrench from the last step; zero while disconnected
  LinkCounts counts{};
  double retry = 0;  // s between two attempts
};

}  // namespace riffler::pen
