#include "riffler/pen/link_status.hpp"

namespace riffler::pen {

const char* link_text(LinkState state) noexcept {
  switch (state) {
    case LinkState::Stopped:
      return "stopped";
    case LinkState::Connected:
      return "connected";
    case LinkState::Waiting:
      return "waiting";
    case LinkState::Connecting:
      break;
  }
  return "connecting";
}

}  // namespace riffler::pen
