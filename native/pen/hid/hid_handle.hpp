// An open HID device, through unmodified hidapi on hidraw.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pen/hid/hid_transport.hpp"
#include "riffler/pen/hid/hid_list.hpp"
#include "riffler/pen/hid/open_error.hpp"

struct hid_device_;

namespace riffler::pen {

/// Whether other programs may use the device at the same time.
enum class Sharing : unsigned char { Exclusive, Shared };

class HidHandle final : public HidTransport {
 public:
  /// Opens the device at `info.path`. Throws OpenError with the exact reason; the text names the udev rule to install
  /// if that helps. hidraw lets any number of programs open a device, and two that push would fight: an exclusive
  /// handle holds a lock (flock) on the device file, and a second one, in any program, gets Busy.
  explicit HidHandle(const HidInfo& info, Sharing sharing = Sharing::Exclusive);
  HidHandle(const HidHandle&) = delete;
  HidHandle& operator=(const HidHandle&) = delete;
  ~HidHandle() override;

  int read(std::span<std::uint8_t> bytes, double seconds) noexcept override;
  bool write(std::span<const std::uint8_t> bytes) noexcept override;
  int get_feature(std::span<std::uint8_t> bytes) noexcept override;
  std::span<const std::uint8_t> descriptor() const noexcept override { return descriptor_; }

 private:
  struct Closing {
    void operator()(hid_device_* device) const noexcept;
  };

  int lock_ = -1;  // file descriptor that holds the lock
  std::vector<std::uint8_t> descriptor_;
  std::unique_ptr<hid_device_, Closing> device_;
};

/// The udev rule that lets the user who sits at the computer open the device, and no other user.
std::string udev_rule(const HidInfo& info);

/// Why `info.path` would not open; OpenProblem::None if it would. Asks only the system; reads nothing from the device.
OpenProblem why_not_open(const HidInfo& info, std::string& text);

}  // namespace riffler::pen
