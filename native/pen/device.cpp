#include "riffler/pen/device.hpp"

#include <limits>

namespace riffler::pen {

const char* not_pushed_text(NotPushed reason) noexcept {
  switch (reason) {
    case NotPushed::NoMotors:
      return "the device has no motors for all of it";
    case NotPushed::NotConnected:
      return "the device is not connected";
    case NotPushed::NotHomed:
      return "the device is not homed";
    case NotPushed::NotPowered:
      return "the device reports a fault or is not ready";
    case NotPushed::BadWrench:
      return "the wrench is not finite";
    case NotPushed::Tripped:
      return "a safety check failed";
    case NotPushed::None:
      break;
  }
  return "";
}

double Pen::age() const noexcept {
  const PenSample sample = newest();
  return sample.sequence == 0 ? std::numeric_limits<double>::infinity() : now() - sample.time;
}

PushAnswer Pen::push(const Wrench& wrench) noexcept {
  if (!finite(wrench)) return {{}, {}, NotPushed::BadWrench};
  const bool asks = !(wrench == Wrench{});
  return {{}, wrench, asks ? NotPushed::NoMotors : NotPushed::None};
}

base::ThreadPriority Pen::priority() const {
  return {0, base::ThreadPriority::By::Nobody, "normal: the device has no thread of its own"};
}

LinkStatus Pen::status() const noexcept {
  LinkStatus out;
  out.state = LinkState::Connected;
  out.sample = newest();
  return out;
}

}  // namespace riffler::pen
