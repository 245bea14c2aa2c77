#include "pen/haply/haply_message.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "pen/service/json_reader.hpp"

namespace riffler::pen {
namespace {

constexpr double kFarthest = 2, kFastest = 100;  // m, m/s: no arm of a desk gets there
constexpr int kFirstVector = 5;                  // from 3.5 on a force is called "vector"; before, "values"

bool is_name(std::string_view text) {
  const auto good = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
  };
  return !text.empty() && text.size() <= kLongestHaplyName && std::all_of(text.begin(), text.end(), good);
}

/// Reads the numbers of an object by their names of one letter, all of which must be there.
template <std::size_t N>
bool numbers(JsonReader& json, const char (&names)[N + 1], std::array<double, N>& values) {
  unsigned found = 0;
  std::string_view key;
  if (!json.object()) return false;
  while (json.key(key)) {
    const std::size_t at = key.size() == 1 ? std::string_view(names, N).find(key[0]) : std::string_view::npos;
    if (at == std::string_view::npos)
      json.skip();
    else if (json.number(values[at]))
      found |= 1U << at;
  }
  return json.ok() && found == (1U << N) - 1;
}

/// False if the JSON or the vector is impossible.
bool vector_within(JsonReader& json, double limit, std::optional<Vec3>& out) {
  std::array<double, 3> v{};
  if (!numbers<3>(json, "xyz", v)) return false;
  out = Vec3(v[0], v[1], v[2]);
  return glm::length(*out) <= limit;
}

bool unit_quaternion(JsonReader& json, std::optional<std::array<double, 4>>& out) {
  constexpr double kTolerance = 0.05;  // grips send 14 bits
  std::array<double, 4> q{};
  if (!numbers<4>(json, "wxyz", q)) return false;
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::abs(length - 1) <= kTolerance)) return false;
  for (double& part : q) part /= length;
  out = q;
  return true;
}

bool truth(JsonReader& json, std::optional<bool>& out) {
  bool value = false;
  if (!json.boolean(value)) return false;
  out = value;
  return true;
}

/// {"a": …, "b": …, "c": …}
bool button_states(JsonReader& json, std::optional<std::uint32_t>& out) {
  std::string_view key;
  std::uint32_t bits = 0;
  if (!json.object()) return false;
  while (json.key(key)) {
    bool down = false;
    if (key == "a" || key == "b" || key == "c") {
      if (json.boolean(down) && down) bits |= 1U << (key[0] - 'a');
    } else {
      json.skip();
    }
  }
  out = bits;
  return json.ok();
}

bool read_state(JsonReader& json, HaplyEntry& entry) {
  std::string_view key;
  if (!json.object()) return false;
  bool good = true;
  while (good && json.key(key)) {
    if (key == "cursor_position" && !entry.is_grip) {
      good = vector_within(json, kFarthest, entry.position);
    } else if (key == "cursor_velocity" && !entry.is_grip) {
      good = vector_within(json, kFastest, entry.velocity);
    } else if (key == "orientation" && entry.is_grip) {
      good = unit_quaternion(json, entry.orientation);
    } else if (key == "buttons" && entry.is_grip) {
      good = button_states(json, entry.buttons);
    } else if (key == "button" && entry.is_grip) {
      std::optional<bool> down;
      good = truth(json, down);
      if (good) entry.buttons = *down ? 1 : 0;
    } else {
      json.skip();
    }
  }
  return good && json.ok();
}

bool read_status(JsonReader& json, HaplyEntry& entry) {
  std::string_view key;
  if (!json.object()) return false;
  while (json.key(key)) {
    if (key == "calibrated")
      truth(json, entry.calibrated);
    else if (key == "in_use")
      truth(json, entry.in_use);
    else if (key == "power_supply")
      truth(json, entry.power_supply);
    else if (key == "ready")
      truth(json, entry.ready);
    else
      json.skip();
  }
  return json.ok();
}

bool read_config(JsonReader& json, HaplyEntry& entry) {
  std::string_view key;
  if (!json.object()) return false;
  while (json.key(key)) {
    if (key == "type")
      json.string(entry.model);
    else
      json.skip();
  }
  return json.ok() && (entry.model.empty() || is_name(entry.model));
}

bool read_entry(JsonReader& json, HaplyEntry& entry) {
  std::string_view key;
  if (!json.object()) return false;
  bool good = true;
  while (good && json.key(key)) {
    if (key == "device_id")
      good = json.string(entry.id) && is_name(entry.id);
    else if (key == "state")
      good = read_state(json, entry);
    else if (key == "status")
      good = read_status(json, entry);
    else if (key == "config")
      good = read_config(json, entry);
    else
      json.skip();
  }
  return good && json.ok() && !entry.id.empty();
}

bool read_entries(JsonReader& json, bool is_grip, HaplyMessage& message) {
  if (!json.array()) return false;
  while (json.element()) {
    if (message.count == HaplyMessage::kMost) return false;
    HaplyEntry& entry = message.entries[message.count++];
    entry = {};
    entry.is_grip = is_grip;
    if (!read_entry(json, entry)) return false;
  }
  return json.ok();
}

std::size_t put(std::span<std::uint8_t> bytes, std::size_t at, std::string_view text) {
  std::copy(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
  return at + text.size();
}

std::size_t put(std::span<std::uint8_t> bytes, std::size_t at, double value) {
  std::array<char, 32> text{};
  // Four decimals: a tenth of a millinewton. A service's force is far below 1e6 N.
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), std::clamp(value, -1e6, 1e6), std::chars_format::fixed, 4);
  static_cast<void>(error);
  return put(bytes, at, std::string_view(text.data(), static_cast<std::size_t>(end - text.data())));
}

}  // namespace

HaplyVersion read_haply_version(std::string_view text) {
  JsonReader json(text);
  std::string_view key, name, number;
  if (json.object())
    while (json.key(key)) {
      if (key == "project_name")
        json.string(name);
      else if (key == "project_version")
        json.string(number);
      else
        json.skip();
    }
  if (!json.done()) throw std::invalid_argument("its version is not JSON");
  if (name != "haply-inverse-service") throw std::invalid_argument("it does not call itself haply-inverse-service");
  HaplyVersion out;
  const char* const end = number.data() + number.size();
  const auto major = std::from_chars(number.data(), end, out.major);
  if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.' ||
      std::from_chars(major.ptr + 1, end, out.minor).ec != std::errc())
    throw std::invalid_argument("its version is not a number");
  return out;
}

const HaplyEntry* HaplyMessage::nth(bool is_grip, std::size_t n) const {
  for (const HaplyEntry& entry : all())
    if (entry.is_grip == is_grip && n-- == 0) return &entry;
  return nullptr;
}

const HaplyEntry* HaplyMessage::named(bool is_grip, std::string_view id) const {
  for (const HaplyEntry& entry : all())
    if (entry.is_grip == is_grip && entry.id == id) return &entry;
  return nullptr;
}

bool read_haply_message(std::string_view text, HaplyMessage& message) noexcept {
  message.count = 0;
  JsonReader json(text);
  std::string_view key;
  if (!json.object()) return false;
  while (json.key(key)) {
    const bool arm = key == "inverse3";
    const bool grip = key == "verse_grip" || key == "wireless_verse_grip" || key == "custom_verse_grip";
    if (arm || grip) {
      if (!read_entries(json, grip, message)) return false;
    } else {
      json.skip();
    }
  }
  return json.done();
}

std::size_t write_haply_force(std::string_view id, const Vec3& force, const HaplyVersion& version,
                              std::span<std::uint8_t> bytes) noexcept {
  const bool vector = version.major > 3 || version.minor >= kFirstVector;
  std::size_t at = put(bytes, 0, R"({"inverse3":[{"device_id":")");
  at = put(bytes, at, id);
  at = put(bytes, at,
           vector ? R"(","commands":{"set_cursor_force":{"vector":{"x":)"
                  : R"(","commands":{"set_cursor_force":{"values":{"x":)");
  at = put(bytes, at, force.x);
  at = put(bytes, at, R"(,"y":)");
  at = put(bytes, at, force.y);
  at = put(bytes, at, R"(,"z":)");
  at = put(bytes, at, force.z);
  return put(bytes, at, "}}}}]}");
}

}  // namespace riffler::pen
