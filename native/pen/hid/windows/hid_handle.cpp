#include "pen/hid/hid_handle.hpp"

namespace riffler::pen {
namespace {

constexpr const char* kNotYet = ": Riffler opens no devices on Windows yet; use Linux";

}  // namespace

HidHandle::HidHandle(const HidInfo& info, Sharing) {
  throw OpenError(OpenProblem::Other, info.path + kNotYet);
}

HidHandle::~HidHandle() = default;

OpenProblem why_not_open(const HidInfo& info, std::string& text) {
  text = info.path + kNotYet;
  return OpenProblem::Other;
}

}  // namespace riffler::pen
