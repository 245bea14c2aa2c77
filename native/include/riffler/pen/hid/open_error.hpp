// Reasons why a device does not open.
#pragma once

#include <stdexcept>
#include <string>

namespace riffler::pen {

/// Why a device did not open.
enum class OpenProblem : unsigned char {
  None,
  NoFile,           // no such path, or nothing is plugged in
  Permission,       // missing permission: a udev rule must be installed
  Forbidden,        // the system refuses every program: a container or sandbox
  Busy,             // in use by another program
  Unplugged,        // disconnected while opening
  NotHid,           // the path is not a HID device
  UnknownDevice,    // no device family matches
  Ambiguous,        // several devices match
  WrongDescriptor,  // the report descriptor does not match the claimed device
  OtherVersion,     // another protocol version
  NoAnswer,         // a required report is not answered
  BadContent,       // the report's content is invalid
  NotRunning,       // the service that drives the device does not run
  NotInstalled,     // the library that drives the device is not there
  NotChosen,        // the library is there, and its user has not asked for it
  WrongLibrary,     // the library cannot be loaded, or lacks a function
  Other,            // see the text
};

/// The problem in a few words, for tables.
const char* problem_text(OpenProblem problem) noexcept;

/// The text states the problem and its remedy.
class OpenError : public std::runtime_error {
 public:
  OpenError(OpenProblem problem, const std::string& text) : std::runtime_error(text), problem_(problem) {}
  OpenProblem problem() const noexcept { return problem_; }

 private:
  OpenProblem problem_;
};

}  // namespace riffler::pen
