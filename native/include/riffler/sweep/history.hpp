// Strokes that stay editable: a base volume and the strokes carved into it, in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/sweep/history_stroke.hpp"

namespace riffler::sweep {

/// Work done by the last edit, and size of the history.
struct HistoryStats {
  std::uint64_t edits = 0;           ///< edits that succeeded so far
  std::uint64_t tiles_restored = 0;  ///< tiles that the last edit set back to an earlier version
  std::uint64_t strokes_run = 0;     ///< strokes that the last edit carved, the new one included
  std::uint64_t tiles_run = 0;       ///< (stroke, tile) pairs that it carved
  std::uint64_t moves_run = 0;       ///< (move, block of 4 × 4 tiles) pairs that it carved
  std::uint64_t tiles_changed = 0;   ///< tiles of the volume that it replaced
  std::uint64_t strokes = 0;         ///< strokes in the history, disabled ones included
  std::uint64_t versions = 0;        ///< tile versions held
  std::uint64_t version_bytes = 0;   ///< bytes of these versions
  std::uint64_t stroke_bytes = 0;    ///< bytes of poses and of the lists of touched tiles
  std::uint64_t stride = 1;          ///< strokes of a tile between two versions held
};

/// A base volume and strokes that can be inserted, replaced, removed, moved and disabled at any time. `volume` is
/// always bit-identical to carving the enabled strokes in order into the base. Each tile keeps its versions after the
/// strokes that touch it. An edit sets the tiles that the edited stroke touches back to the version before it and
/// carves only the later strokes that touch them, and only in these tiles; it stops where a tile has its old content
/// again.
///
/// All edits throw std::invalid_argument for an id that is not in the history and for strokes that `carve` refuses or
/// that have no poses, and Cancelled. After an exception the history is unchanged.
class History {
 public:
  /// Bytes of tile versions, unless the constructor gets another limit.
  static constexpr std::size_t kMemoryLimit = std::size_t{512} << 20;

  /// The base is a snapshot. `memory_limit`: bytes of tile versions. Beyond it, the history keeps every 2nd, 4th, …
  /// version of a tile, and an edit carves up to as many more strokes there. Current versions always stay.
  explicit History(const Volume& base, std::size_t memory_limit = kMemoryLimit);
  History(History&&) noexcept;
  History& operator=(History&&) noexcept;
  ~History();

  /// Adds a stroke at the end, or before another one.
  StrokeId add(HistoryStroke stroke, const Progress& progress = {});
  StrokeId insert(HistoryStroke stroke, StrokeId before, const Progress& progress = {});
  /// Replaces the content of a stroke. It keeps its id and its place, and stays enabled or disabled.
  void replace(StrokeId id, HistoryStroke stroke, const Progress& progress = {});
  void remove(StrokeId id, const Progress& progress = {});
  /// Moves a stroke to the place before another one, or to the end. Before itself: no change.
  void move(StrokeId id, std::optional<StrokeId> before, const Progress& progress = {});
  /// A disabled stroke keeps its place and cuts nothing.
  void enable(StrokeId id, bool enabled, const Progress& progress = {});

  /// The result of the enabled strokes. Its revision changes with its content.
  const Volume& volume() const;
  const Volume& base() const;
  /// All strokes, in order.
  std::vector<StrokeId> ids() const;
  const HistoryStroke& stroke(StrokeId id) const;
  bool enabled(StrokeId id) const;
  HistoryStats stats() const;

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace riffler::sweep
