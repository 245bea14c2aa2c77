#include "pen/hid/hid_handle.hpp"

#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <linux/hidraw.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "pen/hid/hidapi_mutex.hpp"
#include "riffler/pen/hid/hid_list.hpp"

namespace riffler::pen {
namespace {

/// Closes the file unless released.
class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  int take() {
    const int fd = fd_;
    fd_ = -1;
    return fd;
  }

 private:
  int fd_;
};

OpenProblem problem_of(int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return OpenProblem::NoFile;
    case EACCES:
      return OpenProblem::Permission;
    case EPERM:
      return OpenProblem::Forbidden;
    case EBUSY:
    case EAGAIN:
      return OpenProblem::Busy;
    case ENODEV:
    case ENXIO:
    case EIO:
      return OpenProblem::Unplugged;
    case ENOTTY:
    case EINVAL:
      return OpenProblem::NotHid;
    default:
      return OpenProblem::Other;
  }
}

/// Text with the problem and its remedy.
std::string explain(const HidInfo& info, OpenProblem problem, int error) {
  const std::string at = info.path + ": ";
  const std::string id = info.id();
  switch (problem) {
    case OpenProblem::Permission:
      // 73-seat-late.rules evaluates the tag, so the file's number must be lower.
      return at + "permission denied; as root, put this line into /etc/udev/rules.d/60-riffler-" + id.substr(0, 4) +
             "-" + id.substr(5) + ".rules, then unplug the device and plug it in again: " + udev_rule(info);
    case OpenProblem::Forbidden:
      return at + "the system forbids it (a container or a sandbox that was not given the device?)";
    case OpenProblem::Busy:
      return at + "in use by another program; close that program first";
    case OpenProblem::Unplugged:
      return at + "it was unplugged";
    case OpenProblem::NoFile:
      return at + "no such device; is it plugged in?";
    case OpenProblem::NotHid:
      return at + "not a HID device";
    default:
      return at + std::strerror(error);
  }
}

[[noreturn]] void fail(const HidInfo& info, int error) {
  const OpenProblem problem = problem_of(error);
  throw OpenError(problem, explain(info, problem, error));
}

int open_file(const HidInfo& info) {
  const int fd = ::open(info.path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) fail(info, errno);
  return fd;
}

std::vector<std::uint8_t> read_descriptor(const HidInfo& info, int fd) {
  int size = 0;
  if (::ioctl(fd, HIDIOCGRDESCSIZE, &size) < 0) fail(info, errno);
  hidraw_report_descriptor descriptor{};
  if (size < 0 || size > HID_MAX_DESCRIPTOR_SIZE) fail(info, EINVAL);
  descriptor.size = static_cast<std::uint32_t>(size);
  if (::ioctl(fd, HIDIOCGRDESC, &descriptor) < 0) fail(info, errno);
  return {descriptor.value, descriptor.value + size};
}

}  // namespace

HidHandle::HidHandle(const HidInfo& info, Sharing sharing) {
  // First open the file directly: this gives the system's error code, which hidapi turns into a localised text; and
  // hid_open_path 0.13 uses freed memory if the file is not a hidraw device.
  File file(open_file(info));
  if (sharing == Sharing::Exclusive && ::flock(file.get(), LOCK_EX | LOCK_NB) != 0) fail(info, errno);
  descriptor_ = read_descriptor(info, file.get());
  {
    const std::lock_guard lock(hidapi_mutex());
    device_.reset(hid_open_path(info.path.c_str()));
  }
  if (!device_) fail(info, ENODEV);  // it existed a moment ago
  lock_ = file.take();
}

HidHandle::~HidHandle() {
  device_.reset();
  if (lock_ >= 0) ::close(lock_);
}

OpenProblem why_not_open(const HidInfo& info, std::string& text) {
  text.clear();
  try {
    const File file(open_file(info));
    return OpenProblem::None;
  } catch (const OpenError& error) {
    text = error.what();
    return error.problem();
  }
}

}  // namespace riffler::pen
