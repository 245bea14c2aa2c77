#include "verify/event.hpp"

namespace riffler::verify {

bool is_strike(const Event& event) {
  return event.fixture < 0 && event.member != Member::Cutter;
}

}  // namespace riffler::verify
