#include "base/posix/rtkit.hpp"

#include <utility>

namespace riffler::base {

namespace {

constexpr const char* kService = "org.freedesktop.RealtimeKit1";
constexpr const char* kObject = "/org/freedesktop/RealtimeKit1";
constexpr const char* kNonsense = "rtkit answers nonsense";

/// What an error of the bus or of rtkit means, for users.
std::string meaning(const std::string& error) {
  if (error.ends_with(".ServiceUnknown") || error.ends_with(".NameHasNoOwner") || error.ends_with(".Spawn.ExecFailed"))
    return "rtkit is not installed";
  if (error.starts_with("org.freedesktop.")) return "rtkit refuses it (" + error + ')';
  return error;
}

}  // namespace

DbusMessage Rtkit::ask(DbusCall call) {
  try {
    return bus_.call(call);
  } catch (const BusError& error) {
    throw BusError(meaning(error.what()));
  }
}

/// A property that is a number, as a variant of any type of integer.
std::int64_t Rtkit::property(const char* name) {
  DbusWriter body;
  body.string(kService);
  body.string(name);
  const DbusMessage answer = ask({kService, kObject, "org.freedesktop.DBus.Properties", "Get", "ss", body.bytes()});
  DbusReader in(answer.body);
  const std::string type = answer.types == "v" ? in.signature() : "";
  std::int64_t value = 0;
  if (type == "x" || type == "t")
    value = static_cast<std::int64_t>(in.u64());
  else if (type == "i" || type == "u")
    value = static_cast<std::int32_t>(in.u32());
  else
    throw BusError(kNonsense);
  if (in.failed() || value <= 0) throw BusError(kNonsense);
  return value;
}

RtkitLimits Rtkit::limits() {
  const std::int64_t level = property("MaxRealtimePriority");
  if (level > 99) throw BusError(kNonsense);
  return {static_cast<int>(level), property("RTTimeUSecMax")};
}

void Rtkit::make_real_time(pid_t thread, int level) {
  DbusWriter body;
  body.u64(static_cast<std::uint64_t>(thread));
  body.u32(static_cast<std::uint32_t>(level));
  ask({kService, kObject, kService, "MakeThreadRealtime", "tu", body.bytes()});
}

}  // namespace riffler::base
