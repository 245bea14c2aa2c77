#include "pen/hid/hid_choice.hpp"

#include <algorithm>
#include <charconv>

namespace riffler::pen {
namespace {

/// ASCII letters in lower case; other bytes of UTF-8 stay.
std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

}  // namespace

std::vector<std::size_t> chosen(std::span<const HidInfo> devices, std::string_view which) {
  std::vector<std::size_t> out;
  const auto take = [&](const auto& fits) {
    for (std::size_t k = 0; k < devices.size(); ++k)
      if (fits(devices[k])) out.push_back(k);
  };
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), number);
  if (error == std::errc() && end == which.data() + which.size() && number >= 1 && number <= devices.size())
    return {number - 1};
  if (!which.empty()) take([&](const HidInfo& info) { return info.serial == which; });
  if (out.empty()) take([&](const HidInfo& info) { return lower(info.name).find(lower(which)) != std::string::npos; });
  return out;
}

std::string numbered(std::span<const HidInfo> devices) {
  std::string out;
  for (std::size_t k = 0; k < devices.size(); ++k) {
    const HidInfo& info = devices[k];
    out += (k ? "; " : "") + std::to_string(k + 1) + ": \"" + info.name + "\" at " + info.path;
    if (!info.serial.empty()) out += ", serial number " + info.serial;
  }
  return out;
}

}  // namespace riffler::pen
