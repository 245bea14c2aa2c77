// What the simulation of a slab found, row by row.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "riffler/geom/vec.hpp"
#include "riffler/verify/report.hpp"

namespace riffler::verify {

struct Event {
  Kind kind;
  Member member = Member::Cutter;  ///< what of the tool it was
  std::int32_t fixture = -1;       ///< which fixture was met; −1: the stock
  std::int64_t row = 0;
  double value = 0;  ///< mm³, or 0 where it was not measured; of gouges mm
  double worst = 0;  ///< decides between slabs which point is the worst
  Vec3 point{0};     ///< mm, part frame

  bool operator==(const Event&) const = default;
};

/// Whether it is one of shank, holder or beyond in the stock.
bool is_strike(const Event& event);

/// What the moves did; rows that removed nothing are left out of `removed`.
struct SlabReport {
  std::vector<std::pair<std::int64_t, double>> removed;  ///< mm³ of the rays that define Volume::volume()
  std::vector<Event> events;
  std::uint64_t strikes = 0;  ///< of shank, holder and beyond, since the program's start
};

}  // namespace riffler::verify
