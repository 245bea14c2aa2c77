// From the volume that is being cut to the one that is shown: the tiles that have changed, by their pointers.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "riffler/dexel/volume.hpp"
#include "riffler/sweep/move_carver.hpp"

namespace riffler::session {

/// Two threads: one cuts, one shows. Neither waits or sees half of a change: what is handed over is the volume between
/// two cuts, and what it costs is what has changed since the last time. The cutting one allocates nothing.
class TileExchange {
 public:
  using Place = sweep::MoveCarver::Place;
  /// Of the cutter at the moment of handing over; given on as it is.
  struct Mark {
    std::uint64_t strokes = 0;  ///< that were begun so far
    bool in_stroke = false;
  };

  /// For volumes of this frame.
  explicit TileExchange(const Volume& volume);

  // By the thread that cuts.

  void changed(std::span<const Place> places) noexcept;
  /// After each step: hands over what has changed, where that was asked for.
  void serve(const Volume& cut, const Mark& mark) noexcept;

  // By the thread that shows.

  /// Asks for a hand-over with the next step.
  void ask() noexcept;
  /// What was handed over into `shown`, and its places at the end of `places`. False where nothing has come yet.
  bool take(Volume& shown, std::vector<Place>& places, Mark& mark);

 private:
  enum class State : unsigned char { Idle, Asked, Full };

  std::atomic<State> state_{State::Idle};
  // The cutter's.
  std::vector<std::size_t> first_;  // number of each grid's first tile among all
  std::vector<bool> dirty_;
  std::vector<Place> list_;
  // In Idle and Full the shower's, in Asked the cutter's.
  struct Handed {
    Place place;
    std::shared_ptr<const dexel::Tile> tile;
  };
  std::vector<Handed> box_;
  Mark mark_;
};

}  // namespace riffler::session
