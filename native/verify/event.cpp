#include "verify/event.hpp"

namespace riffler::verify {

const char* name_of(Kind kind) {
  static constexpr const char* names[] = {"rapid", "holder",  "shank",   "fixture", "gouge",
                                          "rest",  "spindle", "machine", "unknown"};
  return names[static_cast<int>(kind)];
}

bool is_strike(const Event& event) {
  return event.fixture < 0 && event.member != Member::Cutter;
}

VerifyStats& VerifyStats::operator+=(const VerifyStats& o) {
  moves += o.moves, slabs += o.slabs, slabs_kept += o.slabs_kept, snapshots_used += o.snapshots_used;
  probes += o.probes, probed_moves += o.probed_moves, bisections += o.bisections, skipped += o.skipped;
  return *this;
}

}  // namespace riffler::verify
