// Why a device did not open.
#pragma once

#include <stdexcept>
#include <string>

namespace riffler::pen {

enum class OpenProblem : unsigned char {
  None,
  NoFile,           // no such path, or nothing is plugged in
  Permission,       // a udev rule has to be installed
  Forbidden,        // the system refuses whoever asks: a container or a sandbox
  Busy,             // another program drives it
  Unplugged,        // it went away while it was being opened
  NotHid,           // the path is something else
  UnknownDevice,    // no family takes it
  WrongDescriptor,  // its reports are not those of the device that it claims to be
  OtherVersion,     // of the protocol
  NoAnswer,         // it does not give a report that it must have
  BadContent,       // it does, and what it says cannot be
  Other,            // the text says
};

/// In a few words, for tables.
const char* problem_text(OpenProblem problem) noexcept;

/// The text says what is wrong and what to do.
class OpenError : public std::runtime_error {
 public:
  OpenError(OpenProblem problem, const std::string& text) : std::runtime_error(text), problem_(problem) {}
  OpenProblem problem() const noexcept { return problem_; }

 private:
  OpenProblem problem_;
};

}  // namespace riffler::pen
