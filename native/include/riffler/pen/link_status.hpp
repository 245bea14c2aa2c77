// The connection to a device as other threads see it.
#pragma once

#include <cstdint>

#include "riffler/haptics/wrench.hpp"
#include "riffler/pen/hid/open_error.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::pen {

enum class LinkState : unsigned char {
  Stopped,     // the device was told not to push, and closed
  Connected,   // reports come
  Waiting,     // the device is gone; the next attempt comes after a while
  Connecting,  // somebody looks for it and opens it
};
const char* link_text(LinkState state) noexcept;

/// What happened since the start.
struct LinkCounts {
  std::uint64_t ticks = 0;       // of an open device
  std::uint64_t reports = 0;     // read and understood
  std::uint64_t superseded = 0;  // of them, those that a newer one had overtaken before a step saw them
  std::uint64_t lost = 0;        // that were sent, by their numbers, and never came
  std::uint64_t old = 0;         // that came again or too late
  std::uint64_t malformed = 0;   // pieces that are no report
  std::uint64_t timeouts = 0;    // ticks without a report
  std::uint64_t writes = 0;      // reports sent
  std::uint32_t read_errors = 0, write_errors = 0, silences = 0;  // each ended a connection
  std::uint32_t connections = 0, attempts = 0;
};

/// What other threads see. Trivially copyable.
struct LinkStatus {
  LinkState state = LinkState::Waiting;
  OpenProblem problem = OpenProblem::None;  // of the last attempt to connect
  PenSample sample{};                       // the newest; stays when the device is gone
  Wrench wrench{};                          // asked for by the last step; zero while there is no device
  LinkCounts counts{};
  double retry = 0;  // s from one attempt to the next
};

}  // namespace riffler::pen
