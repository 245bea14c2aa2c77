// What the simulation of a slab found, row by row.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "geom/vec.hpp"
#include "verify/shapes.hpp"

namespace riffler::verify {

enum class Kind : unsigned char { Rapid, Holder, Shank, Fixture, Gouge, Rest, Spindle, Machine, Unknown };

/// "rapid", "holder", …
const char* name_of(Kind kind);

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

/// Operation counts: what a run did, and what it did not need to do.
struct VerifyStats {
  std::uint64_t moves = 0;           ///< (move, slab) pairs cut
  std::uint64_t slabs = 0;           ///< slabs of stock and fixtures simulated, once a chunk
  std::uint64_t slabs_kept = 0;      ///< slabs whose results of the run before were taken
  std::uint64_t snapshots_used = 0;  ///< slabs that were gone on with from a snapshot
  std::uint64_t probes = 0;          ///< batches of moves tried with shank and holder, or on a fixture
  std::uint64_t probed_moves = 0;    ///< moves in them
  std::uint64_t bisections = 0;      ///< batches taken apart to find out which move it was
  std::uint64_t skipped = 0;         ///< (move, slab) pairs told apart by their boxes alone

  VerifyStats& operator+=(const VerifyStats& o);
};

}  // namespace riffler::verify
