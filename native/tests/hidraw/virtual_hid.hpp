// HID devices that stock hidapi and udev take for real ones. umockdev gives their sysfs, device files and ioctls. Its
// device files are terminals, which are streams: they cut and merge reports as hidraw never does. So this program's own
// open() puts a socket that keeps packets apart in the place of the terminal, wherever a file is opened to wait for
// reports, as hidapi does; opened without waiting (O_NONBLOCK), it stays umockdev's. Runs under umockdev-wrapper only.
#pragma once

#include <umockdev.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace riffler::test {

struct VirtualSpec {
  std::uint16_t vendor = 0, product = 0;
  std::string maker, name, serial;
  std::vector<std::uint8_t> descriptor;
  std::map<std::uint8_t, std::vector<std::uint8_t>> features;  // by number, which is the first byte too
};

/// Plugs devices in and out; of one process there is one.
class VirtualBus {
 public:
  VirtualBus();
  VirtualBus(const VirtualBus&) = delete;
  VirtualBus& operator=(const VirtualBus&) = delete;
  ~VirtualBus();

  /// The path: /dev/hidraw0 and so on, never one again.
  std::string plug(const VirtualSpec& spec);
  /// As the kernel does it: the files go, and processes that have the device open read errors.
  void unplug(const std::string& path);

  /// The device's end of the newest connection: a packet for each report. −1 if there was none.
  int device_end(const std::string& path);
  /// What the path leads to; for changing who may open it.
  std::string file(const std::string& path);

  /// By open(): a report channel for `fd`, which was just opened.
  void connect(const std::string& path, int fd);

 private:
  void load_ioctls(const VirtualSpec& spec, const std::string& path);

  UMockdevTestbed* testbed_;
  std::map<std::string, std::string> sysfs_;  // of a path
  std::mutex mutex_;
  std::map<std::string, int> ends_;  // of a path: the device's end
  int next_ = 0;
};

}  // namespace riffler::test
