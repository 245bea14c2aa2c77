#include "base/posix/system_bus.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>

namespace riffler::base {

namespace {

constexpr const char* kUsualAddress = "unix:path=/run/dbus/system_bus_socket";
constexpr std::size_t kLongestLine = 512;  // bytes of an answer to the log-in
constexpr int kMostOthers = 64;            // messages that are no answer before a call is given up

double steady_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The socket's name in an address; an abstract one begins with a zero byte. Empty if it has none.
std::string socket_name(std::string_view address) {
  while (!address.empty()) {
    const std::string_view one = address.substr(0, address.find(';'));
    address.remove_prefix(std::min(one.size() + 1, address.size()));
    if (!one.starts_with("unix:")) continue;
    std::string_view keys = one.substr(5);
    while (!keys.empty()) {
      const std::string_view key = keys.substr(0, keys.find(','));
      keys.remove_prefix(std::min(key.size() + 1, keys.size()));
      if (key.starts_with("path=")) return std::string(key.substr(5));
      if (key.starts_with("abstract=")) return std::string(1, '\0').append(key.substr(9));
    }
  }
  return {};
}

std::string hex(const std::string& text) {
  std::string out;
  for (const char c : text) out += "0123456789abcdef"[c >> 4 & 15], out += "0123456789abcdef"[c & 15];
  return out;
}

}  // namespace

BusCancel::BusCancel() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

BusCancel::~BusCancel() {
  ::close(fd_);
}

void BusCancel::cancel() noexcept {
  const std::uint64_t one = 1;
  // It fails only if it was cancelled 2^64 − 1 times before.
  static_cast<void>(!::write(fd_, &one, sizeof one));
}

std::string system_bus_address() {
  const char* const given = std::getenv("DBUS_SYSTEM_BUS_ADDRESS");
  return given == nullptr || *given == '\0' ? kUsualAddress : given;
}

SystemBus::SystemBus(const std::string& address, double seconds, const BusCancel& cancel)
    : cancel_(cancel), end_(steady_now() + seconds) {
  try {
    connect(address);
    log_in();
    call({"org.freedesktop.DBus", "/org/freedesktop/DBus", "org.freedesktop.DBus", "Hello"});
  } catch (...) {
    if (fd_ >= 0) ::close(fd_);
    throw;
  }
}

SystemBus::~SystemBus() {
  ::close(fd_);
}

void SystemBus::connect(const std::string& address) {
  const std::string name = socket_name(address);
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  if (name.empty() || name.size() >= sizeof to.sun_path) throw BusError(address + " is not the address of a socket");
  std::memcpy(to.sun_path, name.data(), name.size());
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size() + (name[0] == '\0' ? 0 : 1));
  fd_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd_ < 0) throw BusError(std::string("no socket: ") + std::strerror(errno));
  if (::connect(fd_, reinterpret_cast<const sockaddr*>(&to), size) != 0)
    throw BusError("there is no message bus at " + address + ": " + std::strerror(errno));
}

/// By the user's number, which the bus checks with the socket's credentials.
void SystemBus::log_in() {
  const std::string line = std::string(1, '\0') + "AUTH EXTERNAL " + hex(std::to_string(::getuid())) + "\r\n";
  write(reinterpret_cast<const std::uint8_t*>(line.data()), line.size());
  std::string answer;
  while (!answer.ends_with("\r\n")) {
    std::uint8_t one = 0;
    read(&one, 1);
    answer += static_cast<char>(one);
    if (answer.size() > kLongestLine) throw BusError("the message bus answers nonsense");
  }
  if (answer.starts_with("REJECTED")) throw BusError("the message bus refuses this user");
  if (!answer.starts_with("OK ")) throw BusError("the message bus answers nonsense");
  constexpr std::string_view kBegin = "BEGIN\r\n";
  write(reinterpret_cast<const std::uint8_t*>(kBegin.data()), kBegin.size());
}

/// Until the socket is ready. Throws if time is over, or it was cancelled.
void SystemBus::wait(short events) {
  for (;;) {
    const double left = end_ - steady_now();
    if (left <= 0) throw BusError("the message bus does not answer");
    std::array<pollfd, 2> files{pollfd{fd_, events, 0}, pollfd{cancel_.fd_, POLLIN, 0}};
    const int ready = ::poll(files.data(), files.size(), static_cast<int>(std::ceil(1e3 * left)));
    if (ready < 0 && errno != EINTR) throw BusError(std::strerror(errno));
    if (ready <= 0) continue;
    if (files[1].revents != 0) throw BusError("cancelled");
    if (files[0].revents != 0) return;
  }
}

void SystemBus::write(const std::uint8_t* bytes, std::size_t size) {
  while (size > 0) {
    wait(POLLOUT);
    const ssize_t n = ::send(fd_, bytes, size, MSG_NOSIGNAL);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (n < 0) throw BusError("the message bus has closed the connection");
    bytes += n, size -= static_cast<std::size_t>(n);
  }
}

void SystemBus::read(std::uint8_t* bytes, std::size_t size) {
  while (size > 0) {
    wait(POLLIN);
    const ssize_t n = ::recv(fd_, bytes, size, 0);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (n <= 0) throw BusError("the message bus has closed the connection");
    bytes += n, size -= static_cast<std::size_t>(n);
  }
}

DbusMessage SystemBus::receive() {
  std::vector<std::uint8_t> bytes(kDbusStart);
  read(bytes.data(), kDbusStart);
  const std::optional<std::size_t> size = dbus_size(bytes);
  if (!size) throw BusError("the message bus answers nonsense");
  bytes.resize(*size);
  read(bytes.data() + kDbusStart, *size - kDbusStart);
  std::optional<DbusMessage> message = decode(bytes);
  if (!message) throw BusError("the message bus answers nonsense");
  return std::move(*message);
}

DbusMessage SystemBus::call(const DbusCall& call) {
  const std::vector<std::uint8_t> bytes = encode(call, ++serial_);
  write(bytes.data(), bytes.size());
  for (int k = 0; k < kMostOthers; ++k) {
    DbusMessage answer = receive();
    if (answer.reply_to != serial_) continue;
    if (answer.type == DbusMessage::Type::Error) throw BusError(answer.error);
    if (answer.type == DbusMessage::Type::Return) return answer;
  }
  throw BusError("the message bus does not answer");
}

}  // namespace riffler::base
