// Dexel volume: one grid of rays ("x", "y" or "z") or three ("xyz", a tri-dexel volume) over one box.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "riffler/dexel/grid.hpp"
#include "riffler/dexel/stats.hpp"

namespace riffler::dexel {

/// Box (mm), pitch (mm) and directions. Two volumes can be combined if their frames are equal.
struct Frame {
  Box3 box;
  double pitch = 0;
  std::string directions;  // "x", "y", "z" or "xyz"

  bool operator==(const Frame& o) const {
    return box.lower == o.box.lower && box.upper == o.box.upper && pitch == o.pitch && directions == o.directions;
  }
};

/// Copies share their tiles until one of them writes: a copy is a snapshot and costs only pointers.
class Volume {
 public:
  /// An empty volume. Throws std::invalid_argument for an invalid box, pitch or directions and, before anything is
  /// allocated, for a grid that does not fit in the machine's free memory (the message has the bytes).
  explicit Volume(const Frame& frame);
  /// The box full of material. Its spans end exactly at `box.lower` and `box.upper`.
  static Volume block(const Frame& frame);

  const Frame& frame() const { return frame_; }
  /// One grid per direction, in the order of Frame::directions.
  std::vector<Grid>& grids() { return grids_; }
  const std::vector<Grid>& grids() const { return grids_; }
  /// The grid of one direction, or nullptr.
  const Grid* grid(Axis axis) const;
  /// The grid that defines `volume()`: z, or the only one.
  const Grid& reference() const;

  /// Volume of the material, mm³.
  double volume() const { return reference().volume(); }
  /// Bytes in use; each shared tile counts once.
  std::size_t nbytes() const;
  /// Changes with the content; restoring a snapshot restores its revision.
  std::uint64_t revision() const { return revision_; }
  /// Must be called after every change of the content.
  void touch() { revision_ = next_revision(); }

  /// A copy, which shares the tiles.
  Volume snapshot() const { return *this; }
  /// Throws std::invalid_argument if the snapshot has another frame. The counters are not reset.
  void restore(const Volume& snapshot);

  /// Adds to the counters.
  void count(const Stats& stats) { stats_ += stats; }
  /// Returns the counters and resets them.
  Stats take_stats() { return std::exchange(stats_, {}); }

 private:
  Frame frame_;
  std::vector<Grid> grids_;
  std::uint64_t revision_;
  Stats stats_;
};

/// Directions as axes, in the order of the grids. Throws std::invalid_argument unless "x", "y", "z" or "xyz".
std::vector<Axis> parse_directions(const std::string& directions);

/// Estimated bytes of a new volume with one span per ray.
double estimated_bytes(const Frame& frame);

/// Bytes of memory that this machine can still provide; infinity if the system does not report it.
double available_memory();

}  // namespace riffler::dexel

namespace riffler {
using dexel::Volume;
}  // namespace riffler
