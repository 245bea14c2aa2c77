// Events found in the simulation of a slab, per row.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "riffler/geom/vec.hpp"
#include "riffler/verify/report.hpp"

namespace riffler::verify {

struct Event {
  Kind kind;
  Member member = Member::Cutter;  ///< part of the tool
  std::int32_t fixture = -1;       ///< index of the fixture; −1: the stock
  std::int64_t row = 0;
  double value = 0;  ///< mm³, or 0 if not measured; for gouges mm
  double worst = 0;  ///< selects the worst point among slabs
  Vec3 point{0};     ///< mm, part frame

  bool operator==(const Event&) const = default;
};

/// Whether shank, holder or beyond collided with the stock.
bool is_strike(const Event& event);

/// The results of the moves; rows that removed nothing are not in `removed`.
struct SlabReport {
  std::vector<std::pair<std::int64_t, double>> removed;  ///< row and mm³, on the rays that define Volume::volume()
  std::vector<Event> events;
  std::uint64_t strikes = 0;  ///< collisions of shank, holder and beyond since the start of the program
};

}  // namespace riffler::verify
