#include "support/fake_rtkit.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "base/dbus_message.hpp"
#include "base/posix/overrun_guard.hpp"

namespace riffler::test {

namespace {

using base::DbusMessage;

void put_text(base::DbusWriter& out, std::uint8_t field, char type, const std::string& text) {
  out.pad(8);
  out.byte(field);
  out.signature({&type, 1});
  type == 'g' ? out.signature(text) : out.string(text);
}

/// A return, an error (with a name), or a signal for serial 0.
std::vector<std::uint8_t> reply(std::uint32_t to, const std::string& error, const std::string& types = {},
                                const std::vector<std::uint8_t>& body = {}) {
  base::DbusWriter fields;
  if (to == 0) {
    put_text(fields, 1, 'o', "/org/freedesktop/DBus");
    put_text(fields, 2, 's', "org.freedesktop.DBus");
    put_text(fields, 3, 's', "NameAcquired");
  } else {
    fields.pad(8), fields.byte(5), fields.signature("u"), fields.u32(to);
  }
  if (!error.empty()) put_text(fields, 4, 's', error);
  if (!types.empty()) put_text(fields, 8, 'g', types);
  base::DbusWriter out;
  out.byte('l');
  out.byte(to == 0 ? 4 : error.empty() ? 2 : 3);
  out.byte(1), out.byte(1);
  out.u32(static_cast<std::uint32_t>(body.size()));
  out.u32(77);
  out.u32(static_cast<std::uint32_t>(fields.bytes().size()));
  std::vector<std::uint8_t> bytes = out.bytes();
  bytes.insert(bytes.end(), fields.bytes().begin(), fields.bytes().end());
  bytes.resize((bytes.size() + 7) / 8 * 8);
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

bool receive(int fd, std::uint8_t* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::recv(fd, bytes, size, 0);
    if (n <= 0) return false;
    bytes += n, size -= static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

FakeRtkit::FakeRtkit(Does does, int level, std::int64_t microseconds)
    : does_(does), most_(level), microseconds_(microseconds) {
  static std::atomic<int> count{0};
  name_ = "riffler-test-" + std::to_string(::getpid()) + '-' + std::to_string(++count);
  listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un at{};
  at.sun_family = AF_UNIX;
  std::memcpy(at.sun_path + 1, name_.data(), name_.size());
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name_.size());
  if (listener_ < 0 || ::bind(listener_, reinterpret_cast<sockaddr*>(&at), size) != 0 || ::listen(listener_, 4) != 0)
    throw std::runtime_error(std::strerror(errno));
  server_ = std::thread([this] { serve(); });
}

FakeRtkit::~FakeRtkit() {
  ending_ = true;
  ::shutdown(listener_, SHUT_RDWR);
  if (const int fd = connection_; fd >= 0) ::shutdown(fd, SHUT_RDWR);
  server_.join();
  ::close(listener_);
}

std::string FakeRtkit::address() const {
  return "tcp:host=none;unix:abstract=" + name_ + ",guid=00";
}

bool FakeRtkit::send(int fd, const std::vector<std::uint8_t>& bytes) {
  return ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

void FakeRtkit::serve() {
  while (!ending_) {
    const int fd = ::accept(listener_, nullptr, nullptr);
    if (fd < 0) return;
    connection_ = fd;
    bool goes_on = log_in(fd);
    while (goes_on && !ending_) {
      std::vector<std::uint8_t> bytes(base::kDbusStart);
      if (!receive(fd, bytes.data(), bytes.size())) break;
      const auto size = base::dbus_size(bytes);
      if (!size) break;
      bytes.resize(*size);
      if (!receive(fd, bytes.data() + base::kDbusStart, *size - base::kDbusStart)) break;
      goes_on = answer(fd, bytes);
    }
    connection_ = -1;
    ::close(fd);
  }
}

bool FakeRtkit::log_in(int fd) {
  std::string line;
  while (!line.ends_with("\r\n")) {
    std::uint8_t one = 0;
    if (!receive(fd, &one, 1)) return false;
    line += static_cast<char>(one);
  }
  if (line.compare(0, 15, std::string(1, '\0') + "AUTH EXTERNAL ") != 0) return false;
  const auto say = [&](const std::string& text) { return send(fd, {text.begin(), text.end()}); };
  if (does_ == Does::HangsUp) return false;
  if (does_ == Does::RejectsLogIn) return say("REJECTED EXTERNAL\r\n");
  if (does_ == Does::NeverLogsIn) return receive(fd, reinterpret_cast<std::uint8_t*>(line.data()), 1);
  char begin[7];
  return say("OK 0123456789abcdef0123456789abcdef\r\n") && receive(fd, reinterpret_cast<std::uint8_t*>(begin), 7) &&
         std::string(begin, 7) == "BEGIN\r\n";
}

bool FakeRtkit::answer(int fd, const std::vector<std::uint8_t>& bytes) {
  const auto call = base::decode(bytes);
  if (!call || call->type != DbusMessage::Type::Call) return false;
  const std::uint32_t to = call->serial;
  base::DbusWriter body;
  if (call->member == "Hello") {
    body.string(":1.7");
    return send(fd, reply(to, "", "s", body.bytes())) && send(fd, reply(0, "", "s", body.bytes()));
  }
  if (call->path != "/org/freedesktop/RealtimeKit1") return send(fd, reply(to, "org.freedesktop.DBus.Error.Failed"));
  if (does_ == Does::IsSilent) return true;
  if (does_ == Does::SaysNonsense) return send(fd, std::vector<std::uint8_t>(64, 0xA5));
  if (does_ == Does::IsNotInstalled) return send(fd, reply(to, "org.freedesktop.DBus.Error.ServiceUnknown"));
  base::DbusReader in(call->body);
  if (call->interface == "org.freedesktop.DBus.Properties" && call->member == "Get") {
    in.string();
    const std::string name = in.string();
    if (does_ == Does::NamesNoNumber) {
      body.signature("s"), body.string("many");
    } else if (name == "MaxRealtimePriority") {
      body.signature("i"), body.u32(does_ == Does::NamesHugeLevel ? 1000U : static_cast<std::uint32_t>(most_));
    } else {
      body.signature("x"), body.u64(static_cast<std::uint64_t>(microseconds_));
    }
    return send(fd, reply(to, "", "v", body.bytes()));
  }
  const auto thread = static_cast<pid_t>(in.u64());
  const auto level = static_cast<int>(in.u32());
  if (call->member != "MakeThreadRealtime" || call->types != "tu" || in.failed()) return false;
  ++asked_, level_ = level;
  if (does_ == Does::Refuses) return send(fd, reply(to, "org.freedesktop.DBus.Error.AccessDenied"));
  if (does_ == Does::Grants && base::schedule_thread(thread, level) != 0)
    return send(fd, reply(to, "org.freedesktop.DBus.Error.Failed"));
  return send(fd, reply(to, ""));
}

}  // namespace riffler::test
