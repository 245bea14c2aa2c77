#include "virtual_hid.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <linux/hidraw.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdarg>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace riffler::test {
namespace {

std::atomic<VirtualBus*> the_bus{nullptr};

std::string hex(const std::uint8_t* bytes, std::size_t n) {
  constexpr char digits[] = "0123456789ABCDEF";
  std::string out;
  for (std::size_t k = 0; k < n; ++k) out += digits[bytes[k] >> 4], out += digits[bytes[k] & 15];
  return out;
}

std::string hex(const std::vector<std::uint8_t>& bytes) {
  return hex(bytes.data(), bytes.size());
}

std::string hex4(unsigned number) {
  const std::uint8_t bytes[] = {static_cast<std::uint8_t>(number >> 8), static_cast<std::uint8_t>(number)};
  return hex(bytes, 2);
}

void check(gboolean done, GError* error) {
  if (done) return;
  const std::string text = error != nullptr ? error->message : "umockdev failed";
  g_clear_error(&error);
  throw std::runtime_error(text);
}

/// The hidraw node, its HID device, its interface, its USB device: what udev walks up.
std::string description(const VirtualSpec& spec, const std::string& sysfs, const std::string& node, int number) {
  const std::string hid = sysfs.substr(0, sysfs.rfind("/hidraw/")), interface = hid.substr(0, hid.rfind('/'));
  const std::string usb = interface.substr(0, interface.rfind('/'));
  const std::string id = "0003:0000" + hex4(spec.vendor) + ":0000" + hex4(spec.product), n = std::to_string(number);
  return "P: " + sysfs + "\nN: " + node + "\nE: DEVNAME=/dev/" + node + "\nE: MAJOR=240\nE: MINOR=" + n +
         "\nE: SUBSYSTEM=hidraw\nL: device=../../.." + hid.substr(hid.rfind('/')) + "\nA: dev=240:" + n +
         "\\n\n\n" +                                                                                          //
         "P: " + hid + "\nE: SUBSYSTEM=hid\nE: DRIVER=hid-generic\nE: HID_ID=" + id + "\nE: HID_NAME=" +      //
         spec.maker + " " + spec.name + "\nE: HID_UNIQ=" + spec.serial +                                      //
         "\nH: report_descriptor=" + hex(spec.descriptor) + "\n\n" +                                          //
         "P: " + interface + "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\\n\n\n" +  //
         "P: " + usb + "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nA: idVendor=" + hex4(spec.vendor) +
         "\\n\nA: idProduct=" + hex4(spec.product) + "\\n\nA: manufacturer=" + spec.maker +
         "\\n\nA: product=" + spec.name + "\\n\nA: serial=" + spec.serial + "\\n\n\n";
}

}  // namespace

VirtualBus::VirtualBus() : testbed_(umockdev_testbed_new()) {
  the_bus = this;
  // Everybody may look, as in /sys and /dev.
  gchar* root = umockdev_testbed_get_root_dir(testbed_);
  chmod(root, 0755);
  g_free(root);
}

VirtualBus::~VirtualBus() {
  the_bus = nullptr;
  for (const auto& [path, fd] : ends_) close(fd);
  g_object_unref(testbed_);
}

std::string VirtualBus::plug(const VirtualSpec& spec) {
  const int number = next_++;
  const std::string node = "hidraw" + std::to_string(number), path = "/dev/" + node;
  const std::string port = "/devices/pci0000:00/usb1/1-" + std::to_string(number + 1);
  const std::string id = "0003:" + hex4(spec.vendor) + ":" + hex4(spec.product) + ".000" + std::to_string(number);
  sysfs_[path] = port + "/" + port.substr(port.rfind('/') + 1) + ":1.0/" + id + "/hidraw/" + node;
  GError* error = nullptr;
  check(umockdev_testbed_add_from_string(testbed_, description(spec, sysfs_[path], node, number).c_str(), &error),
        error);
  load_ioctls(spec, path);
  return path;
}

void VirtualBus::load_ioctls(const VirtualSpec& spec, const std::string& path) {
  gchar* root = umockdev_testbed_get_root_dir(testbed_);
  const std::string file = std::string(root) + "/ioctls" + path.substr(path.rfind('/') + 1);
  const std::string socket = root + ("/ioctl" + path);
  g_free(root);
  hidraw_report_descriptor descriptor{};
  descriptor.size = static_cast<std::uint32_t>(spec.descriptor.size());
  std::copy(spec.descriptor.begin(), spec.descriptor.end(), descriptor.value);
  const auto bytes = [](const auto& value) { return hex(reinterpret_cast<const std::uint8_t*>(&value), sizeof value); };
  std::ofstream out(file);
  out << "@DEV " << path << "\nHIDIOCGRDESCSIZE 0 " << bytes(descriptor.size) << "\nHIDIOCGRDESC 0 "
      << bytes(descriptor) << "\n";
  // Looked up by their lengths.
  for (const auto& [number, report] : spec.features)
    out << "HIDIOCGFEATURE " << report.size() << " " << hex(report) << "\n";
  out.close();
  GError* error = nullptr;
  check(umockdev_testbed_load_ioctl(testbed_, path.c_str(), file.c_str(), &error), error);
  // umockdev connects before it looks at whether the file may be opened, and ends the program where it cannot.
  chmod(socket.c_str(), 0666);
}

int VirtualBus::device_end(const std::string& path) {
  const std::lock_guard lock(mutex_);
  const auto end = ends_.find(path);
  return end == ends_.end() ? -1 : end->second;
}

void VirtualBus::connect(const std::string& path, int fd) {
  const std::lock_guard lock(mutex_);
  if (!sysfs_.contains(path)) return;
  int pair[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair) != 0) return;
  // umockdev still knows the number for its ioctls.
  dup2(pair[0], fd);
  close(pair[0]);
  const auto [end, first] = ends_.try_emplace(path, pair[1]);
  if (!first) close(end->second), end->second = pair[1];
}

std::string VirtualBus::file(const std::string& path) {
  return ptsname(umockdev_testbed_get_dev_fd(testbed_, path.c_str()));
}

void VirtualBus::unplug(const std::string& path) {
  const int fd = umockdev_testbed_get_dev_fd(testbed_, path.c_str());
  // umockdev keeps the terminal by its name, which the system gives to the next one.
  std::string name = ptsname(fd);
  std::replace(name.begin(), name.end(), '/', '_');
  gchar* root = umockdev_testbed_get_root_dir(testbed_);
  unlink((std::string(root) + "/dev/.ptymap/" + name).c_str());
  g_free(root);
  umockdev_testbed_remove_device(testbed_, ("/sys" + sysfs_.at(path)).c_str());
  // umockdev will close that number once more; until then it is another file.
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(null, fd);
  close(null);
  const std::lock_guard lock(mutex_);
  sysfs_.erase(path);
  if (const auto end = ends_.find(path); end != ends_.end()) close(end->second), ends_.erase(end);
}

}  // namespace riffler::test

/// Comes before the C library's and umockdev's, for hidapi too.
extern "C" __attribute__((visibility("default"))) int open(const char* path, int flags, ...) {
  using Open = int (*)(const char*, int, ...);
  static const Open next = reinterpret_cast<Open>(dlsym(RTLD_NEXT, "open"));
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  const int fd = next(path, flags, mode);
  riffler::test::VirtualBus* const bus = riffler::test::the_bus;
  if (fd >= 0 && bus != nullptr && (flags & O_NONBLOCK) == 0 && std::strncmp(path, "/dev/hidraw", 11) == 0)
    bus->connect(path, fd);
  return fd;
}
