// What a search for devices returns.
#pragma once

#include <string>

#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {

/// A family of devices: HID devices of one protocol, or those behind one maker's program or library.
struct PenFamily {
  const char* kind;  ///< what open_pen takes
  const char* what;  ///< for users
};

/// A device found by a search.
struct FoundDevice {
  std::string path;  ///< what open_pen takes
  std::string name, maker, serial;
  std::string choice;  ///< "kind:number", which open_pen takes, where there are several HID devices of a kind
  std::string id;      ///< vendor:product of a HID device, otherwise empty
  const PenFamily* family = nullptr;  ///< null: not supported by Riffler
  /// False: no device, but the reason why this family finds none, such as a service that does not run.
  bool is_there = true;
  bool was_opened = false;  ///< opened and identified; otherwise only permission was checked
  OpenProblem problem = OpenProblem::None;
  std::string text;        ///< why it does not open, and the remedy
  std::string capability;  ///< what is sensed and pushed; only for opened devices
  std::string about;
};

}  // namespace riffler::pen
