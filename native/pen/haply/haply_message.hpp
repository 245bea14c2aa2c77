// The messages of Haply's Inverse Service, version 3.1 and later (port 10001), and its version.
//
// The forms come from the maker's published documentation of the service (https://docs.haply.co/inverseSDK/service,
// pages "WebSocket protocol", "Control commands", "HTTP" and the tutorials 01, 02 and 06, of 3.1 and 3.5). The service
// sends all devices at once after the connection, with their configuration and status, and afterwards one state for
// each message it receives. Positions are in m, velocities in m/s, forces in N; x is right, y away from the user, z up,
// as in Riffler. No code was taken.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "riffler/geom/vec.hpp"

namespace riffler::pen {

/// Numbers of the service's version.
struct HaplyVersion {
  int major = 0, minor = 0;
};

/// From the body of GET /version. Throws std::invalid_argument if it is not that of an Inverse Service.
HaplyVersion read_haply_version(std::string_view json);

/// One device in a message. Texts refer to the message. What a message does not contain has no value.
struct HaplyEntry {
  bool is_grip = false;                              // a VerseGrip, otherwise an arm
  std::string_view id;                               // letters, digits, "-" and "_"
  std::string_view model;                            // config.type: "inverse3", "minverse" …
  std::optional<Vec3> position;                      // m
  std::optional<Vec3> velocity;                      // m/s
  std::optional<std::array<double, 4>> orientation;  // unit quaternion w x y z: from the grip's axes to the device's
  std::optional<std::uint32_t> buttons;              // bit 0 is "a", or the only button
  std::optional<bool> calibrated, in_use, power_supply, ready;
};

/// The arms and grips of a message in its order.
struct HaplyMessage {
  static constexpr std::size_t kMost = 16;
  std::array<HaplyEntry, kMost> entries{};
  std::size_t count = 0;

  std::span<const HaplyEntry> all() const { return std::span(entries).first(count); }
  /// The n-th arm or grip; null if there are fewer.
  const HaplyEntry* nth(bool is_grip, std::size_t n) const;
  /// The arm or grip with that name; null if it is not there.
  const HaplyEntry* named(bool is_grip, std::string_view id) const;
};

/// Decodes a message without allocating. False if it is not JSON, or a field that matters here has an impossible value:
/// a wrong type, a position beyond 2 m, a speed beyond 100 m/s, a quaternion that is not of unit length, a name with
/// other characters.
bool read_haply_message(std::string_view json, HaplyMessage& message) noexcept;

/// Writes the message that applies a force (N) to the arm `id` and asks for its state. `bytes` must hold
/// kLongestHaplyCommand; the name at most kLongestHaplyName. Returns its size.
inline constexpr std::size_t kLongestHaplyName = 64, kLongestHaplyCommand = 320;
std::size_t write_haply_force(std::string_view id, const Vec3& force, const HaplyVersion& version,
                              std::span<std::uint8_t> bytes) noexcept;

}  // namespace riffler::pen
