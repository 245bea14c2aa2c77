// Passes changed tiles, by pointer, from the volume being cut to the one being displayed.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "riffler/dexel/volume.hpp"
#include "riffler/sweep/move_carver.hpp"

namespace riffler::session {

/// For two threads: one cuts, one displays. Neither waits or sees a partial change: each hand-over is the state between
/// two cuts, and its cost is that of the changes since the last. The cutting side allocates nothing.
class TileExchange {
 public:
  using Place = sweep::MoveCarver::Place;
  /// State of the cutting side at the hand-over, passed through unchanged.
  struct Mark {
    std::uint64_t strokes = 0;  ///< strokes begun so far
    bool in_stroke = false;
  };

  /// For volumes of the frame of `volume`.
  explicit TileExchange(const Volume& volume);

  // By the cutting thread.

  /// Marks tiles as changed.
  void changed(std::span<const Place> places) noexcept;
  /// Whether the other thread has requested a hand-over.
  bool asked() const noexcept { return state_.load(std::memory_order_acquire) == State::Asked; }
  /// After each step: hands over the changes if the other thread has requested them.
  void serve(const Volume& cut, const Mark& mark) noexcept;

  // By the displaying thread.

  /// Requests a hand-over with the next step.
  void ask() noexcept;
  /// Applies the handed-over tiles to `shown` and appends their places to `places`. False if nothing was handed over
  /// yet.
  bool take(Volume& shown, std::vector<Place>& places, Mark& mark);

 private:
  enum class State : unsigned char { Idle, Asked, Full };

  std::atomic<State> state_{State::Idle};
  // Used by the cutting thread.
  std::vector<std::size_t> first_;  // index of each grid's first tile in the list of all tiles
  std::vector<bool> dirty_;
  std::vector<Place> list_;
  // Owned by the displaying thread in Idle and Full, by the cutting thread in Asked.
  struct Handed {
    Place place;
    std::shared_ptr<const dexel::Tile> tile;
  };
  std::vector<Handed> box_;
  Mark mark_;
};

}  // namespace riffler::session
