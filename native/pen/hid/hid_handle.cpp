#include "pen/hid/hid_handle.hpp"

#include <hidapi/hidapi.h>

#include <cmath>

namespace riffler::pen {
namespace {

constexpr char kPlain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 ._-";

}  // namespace

void HidHandle::Closing::operator()(hid_device_* device) const noexcept {
  hid_close(device);
}

int HidHandle::read(std::span<std::uint8_t> bytes, double seconds) noexcept {
  return hid_read_timeout(device_.get(), bytes.data(), bytes.size(), static_cast<int>(std::ceil(1e3 * seconds)));
}

bool HidHandle::write(std::span<const std::uint8_t> bytes) noexcept {
  return hid_write(device_.get(), bytes.data(), bytes.size()) >= 0;
}

int HidHandle::get_feature(std::span<std::uint8_t> bytes) noexcept {
  return hid_get_feature_report(device_.get(), bytes.data(), bytes.size());
}

std::string udev_rule(const HidInfo& info) {
  const std::string id = info.id();
  std::string rule = R"(ACTION!="remove", SUBSYSTEM=="hidraw", ATTRS{idVendor}==")" + id.substr(0, 4) +
                     R"(", ATTRS{idProduct}==")" + id.substr(5) + '"';
  // Several makers use these numbers, so also match the name. Characters like * have a meaning in udev rules.
  if (!info.name.empty() && info.name.find_first_not_of(kPlain) == std::string::npos)
    rule += R"(, ATTRS{product}==")" + info.name + '"';
  return rule + R"(, TAG+="uaccess")";
}

const char* problem_text(OpenProblem problem) noexcept {
  switch (problem) {
    case OpenProblem::None:
      return "none";
    case OpenProblem::NoFile:
      return "not there";
    case OpenProblem::Permission:
      return "permission denied";
    case OpenProblem::Forbidden:
      return "forbidden by the system";
    case OpenProblem::Busy:
      return "busy";
    case OpenProblem::Unplugged:
      return "unplugged";
    case OpenProblem::NotHid:
      return "not a HID device";
    case OpenProblem::Ambiguous:
      return "several of that name";
    case OpenProblem::UnknownDevice:
      return "unknown device";
    case OpenProblem::WrongDescriptor:
      return "wrong report descriptor";
    case OpenProblem::OtherVersion:
      return "other protocol version";
    case OpenProblem::NoAnswer:
      return "no answer";
    case OpenProblem::BadContent:
      return "contradicts itself";
    case OpenProblem::NotRunning:
      return "not running";
    case OpenProblem::NotInstalled:
      return "not installed";
    case OpenProblem::NotChosen:
      return "not chosen";
    case OpenProblem::WrongLibrary:
      return "wrong library";
    case OpenProblem::Other:
      break;
  }
  return "system error";
}

}  // namespace riffler::pen
