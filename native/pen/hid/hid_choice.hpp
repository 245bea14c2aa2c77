// Chooses one of several HID devices of a kind by what a user calls it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "riffler/pen/hid/hid_list.hpp"

namespace riffler::pen {

/// Indices of the devices that `which` names: the number of one from 1 on, a serial number, or else a part of a name in
/// any case. Empty: all of them.
std::vector<std::size_t> chosen(std::span<const HidInfo> devices, std::string_view which);

/// The devices in one line, each with its number: `1: "SpaceMouse Wireless" at /dev/hidraw3, serial number 7; 2: …`.
std::string numbered(std::span<const HidInfo> devices);

}  // namespace riffler::pen
