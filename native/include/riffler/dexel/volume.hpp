// Dexel volume: one grid of rays ("x", "y" or "z") or three ("xyz", a tri-dexel volume) over one box.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "riffler/dexel/grid.hpp"
#include "riffler/dexel/stats.hpp"

namespace riffler::dexel {

/// Box, pitch and directions: what two volumes must share to be combined.
struct Frame {
  Box3 box;
  double pitch = 0;
  std::string directions;  // "x", "y", "z" or "xyz"

  bool operator==(const Frame& o) const {
    return box.lower == o.box.lower && box.upper == o.box.upper && pitch == o.pitch && directions == o.directions;
  }
};

/// Copies share their tiles until one of them writes, so a copy *is* a snapshot and costs pointers only.
class Volume {
 public:
  /// An empty volume. Throws std::invalid_argument for a box, pitch or directions that make no sense, and, before
  /// anything is allocated, for a grid that this machine's free memory cannot hold (the message has the bytes).
  explicit Volume(const Frame& frame);
  /// The box full of material; its spans end exactly at `box.lower` and `box.upper`.
  static Volume block(const Frame& frame);

  const Frame& frame() const { return frame_; }
  std::vector<Grid>& grids() { return grids_; }
  const std::vector<Grid>& grids() const { return grids_; }
  /// The grid of one direction, or nullptr.
  const Grid* grid(Axis axis) const;
  /// The grid that defines `volume()`: z, or the only one there is.
  const Grid& reference() const;

  double volume() const { return reference().volume(); }
  std::size_t nbytes() const;
  /// Changes whenever the content does; a restored snapshot brings its number back.
  std::uint64_t revision() const { return revision_; }
  /// Called by whatever changed the content.
  void touch() { revision_ = next_revision(); }

  Volume snapshot() const { return *this; }
  /// Throws std::invalid_argument if the snapshot's frame is another one. Counters go on.
  void restore(const Volume& snapshot);

  /// Adds to the counters; `take_stats` returns and clears them.
  void count(const Stats& stats) { stats_ += stats; }
  Stats take_stats() { return std::exchange(stats_, {}); }

 private:
  Frame frame_;
  std::vector<Grid> grids_;
  std::uint64_t revision_;
  Stats stats_;
};

/// Directions as axes, in the order of the grids; std::invalid_argument for anything but "x", "y", "z", "xyz".
std::vector<Axis> parse_directions(const std::string& directions);

/// Bytes that a fresh volume of one span a ray would take.
double estimated_bytes(const Frame& frame);

/// Memory that this machine can still give, bytes; infinity where the system does not say.
double available_memory();

}  // namespace riffler::dexel

namespace riffler {
using dexel::Volume;
}  // namespace riffler
