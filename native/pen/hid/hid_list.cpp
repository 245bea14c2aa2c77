#include "riffler/pen/hid/hid_list.hpp"

#include <hidapi/hidapi.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "pen/hid/hidapi_mutex.hpp"

namespace riffler::pen {
namespace {

void append_utf8(std::string& out, std::uint32_t c) {
  const auto tail = [&](int shift) { out += static_cast<char>(0x80 | ((c >> shift) & 0x3F)); };
  if (c >= 0x110000 || (c >= 0xD800 && c < 0xE000)) c = 0xFFFD;
  if (c < 0x80) {
    out += static_cast<char>(c);
  } else if (c < 0x800) {
    out += static_cast<char>(0xC0 | (c >> 6)), tail(0);
  } else if (c < 0x10000) {
    out += static_cast<char>(0xE0 | (c >> 12)), tail(6), tail(0);
  } else {
    out += static_cast<char>(0xF0 | (c >> 18)), tail(12), tail(6), tail(0);
  }
}

/// Converts hidapi's wide strings: UTF-32 on Linux, UTF-16 on Windows. Avoids the C library's functions, which depend
/// on the locale.
std::string to_utf8(const wchar_t* text) {
  std::string out;
  for (; text != nullptr && *text != 0; ++text) {
    auto c = static_cast<std::uint32_t>(*text);
    const auto next = static_cast<std::uint32_t>(text[1]);
    if (sizeof(wchar_t) == 2 && c >= 0xD800 && c < 0xDC00 && next >= 0xDC00 && next < 0xE000)
      c = 0x10000 + ((c - 0xD800) << 10) + (next - 0xDC00), ++text;
    append_utf8(out, c);
  }
  return out;
}

/// The kernel's name of the device. hidapi decodes names with mbstowcs, which fails in the C locale for names that are
/// not ASCII (linux/hid.c of 0.13, utf8_to_wchar_t), and has none for Bluetooth devices.
std::string name_of_kernel(const std::string& path) {
  std::ifstream file("/sys/class/hidraw/" + path.substr(path.rfind('/') + 1) + "/device/uevent");
  constexpr std::string_view key = "HID_NAME=";
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key)) return line.substr(key.size());
  return {};
}

HidInfo to_info(const hid_device_info& d) {
  HidInfo info;
  info.path = d.path;
  info.vendor = d.vendor_id;
  info.product = d.product_id;
  info.maker = to_utf8(d.manufacturer_string);
  info.name = to_utf8(d.product_string);
  if (info.name.empty()) info.name = name_of_kernel(info.path);
  info.serial = to_utf8(d.serial_number);
  info.interface = d.interface_number;
  return info;
}

/// Sorts hidraw10 after hidraw9.
bool path_before(const HidInfo& a, const HidInfo& b) {
  return a.path.size() != b.path.size() ? a.path.size() < b.path.size() : a.path < b.path;
}

}  // namespace

bool HidInfo::has_usage(std::uint16_t page, std::uint16_t usage) const {
  return std::find(usages.begin(), usages.end(), std::pair{page, usage}) != usages.end();
}

std::string HidInfo::id() const {
  constexpr char digits[] = "0123456789abcdef";
  std::string out;
  for (const std::uint16_t number : {vendor, product}) {
    if (!out.empty()) out += ':';
    for (int shift = 12; shift >= 0; shift -= 4) out += digits[(number >> shift) & 15];
  }
  return out;
}

std::vector<HidInfo> list_hid() {
  const std::lock_guard lock(hidapi_mutex());
  if (hid_init() != 0) throw std::runtime_error("hidapi cannot start");
  std::vector<HidInfo> out;
  hid_device_info* const all = hid_enumerate(0, 0);
  for (const hid_device_info* d = all; d != nullptr; d = d->next) {
    if (d->path == nullptr) continue;
    // hidapi lists a device once per collection.
    auto known = std::find_if(out.begin(), out.end(), [&](const HidInfo& i) { return i.path == d->path; });
    if (known == out.end()) known = out.insert(out.end(), to_info(*d));
    if (d->usage_page != 0 || d->usage != 0) known->usages.emplace_back(d->usage_page, d->usage);
  }
  hid_free_enumeration(all);
  std::sort(out.begin(), out.end(), path_before);
  return out;
}

HidAddress HidAddress::of(const HidInfo& info) {
  return {info.path, info.vendor, info.product, info.serial, info.interface};
}

const HidInfo* find_again(const std::vector<HidInfo>& found, const HidAddress& address) {
  const HidInfo* first = nullptr;
  for (const HidInfo& info : found) {
    const bool same = info.vendor == address.vendor && info.product == address.product &&
                      info.serial == address.serial && info.interface == address.interface;
    if (!same) continue;
    if (info.path == address.path) return &info;
    if (first == nullptr) first = &info;
  }
  return first;
}

}  // namespace riffler::pen
