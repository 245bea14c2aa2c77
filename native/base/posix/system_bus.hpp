// A connection to the system's message bus (D-Bus) for a few calls, each bounded in time.
#pragma once

#include <stdexcept>
#include <string>

#include "base/dbus_message.hpp"

namespace riffler::base {

/// Why a call failed, as a text for users.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Lets another thread end the calls of a SystemBus at once.
class BusCancel {
 public:
  BusCancel();  ///< Throws std::system_error if the system has no more file descriptors.
  ~BusCancel();
  BusCancel(const BusCancel&) = delete;
  BusCancel& operator=(const BusCancel&) = delete;
  void cancel() noexcept;

 private:
  friend class SystemBus;
  int fd_;
};

/// Address of the system's bus: DBUS_SYSTEM_BUS_ADDRESS, or the usual one.
std::string system_bus_address();

/// One thread at a time.
class SystemBus {
 public:
  /// Connects and logs in. `address`: "unix:path=…" or "unix:abstract=…", the first of a list that is of this kind.
  /// All calls together must end within `seconds`. Throws BusError.
  SystemBus(const std::string& address, double seconds, const BusCancel& cancel);
  ~SystemBus();
  SystemBus(const SystemBus&) = delete;
  SystemBus& operator=(const SystemBus&) = delete;

  /// The answer to a call. Throws BusError if there is none, or with the name of an error that the other side returns.
  DbusMessage call(const DbusCall& call);

 private:
  void connect(const std::string& address);
  void log_in();
  void wait(short events);
  void write(const std::uint8_t* bytes, std::size_t size);
  void read(std::uint8_t* bytes, std::size_t size);
  DbusMessage receive();

  int fd_ = -1;
  const BusCancel& cancel_;
  double end_;  // s, of the steady clock
  std::uint32_t serial_ = 0;
};

}  // namespace riffler::base
