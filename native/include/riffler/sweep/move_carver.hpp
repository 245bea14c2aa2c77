// Carves with one tool on one volume, one move per call, in real time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::sweep {

/// Real-time `carve`, one move per call: bit-identical volume and result. Allocates no memory from the system after the
/// first moves, as long as moves keep their size and the tiles that they replace are freed (block_pool.hpp): a step of
/// the pen has a deadline.
class MoveCarver {
 public:
  struct Options {
    double tolerance = 0.01;         ///< mm, as in CarveOptions
    double removal_constant = 0.05;  ///< N·s/mm³
    /// Whether the volume gets what was cut only in `publish`. Tiles stay open until then, so a move takes a fraction
    /// of the time.
    bool deferred = false;
  };
  /// Result of one move.
  struct Taken {
    double removed = 0;        ///< mm³
    Vec3 force{0}, torque{0};  ///< on the tool, against its motion: N; N·mm about the tip at the end of the move
  };

  /// `volume` must outlive the carver and must not be moved. Throws std::invalid_argument as `carve` does.
  MoveCarver(Volume& volume, const Tool& tool, const Options& options);
  MoveCarver(const MoveCarver&) = delete;
  MoveCarver& operator=(const MoveCarver&) = delete;
  ~MoveCarver();

  /// Carves one move of duration `dt` (s). Throws std::invalid_argument as `carve` does; the volume is then unchanged.
  /// If memory runs out (std::bad_alloc), deferred material may be cut in part; the same move, repeated, completes it.
  Taken move(const Pose& from, const Pose& to, double dt);
  /// Whether the last move cut something. Deferred: also where it follows close on a move that did.
  bool cut_something() const;

  /// Deferred: gives the volume what moves have cut since the last call. May throw std::bad_alloc.
  void publish();
  /// Deferred: same, a part in each call, so that no step of a pen takes much longer than the others. Call it once a
  /// step until it returns true. `publishing` is true from the call on that fixes what is published: the volume finally
  /// has all that was cut before that call, and nothing that was cut since. Until then it may have that in some places
  /// only. May throw std::bad_alloc; the next call continues.
  bool publish_part();
  bool publishing() const;
  /// Deferred: forgets what is not published. Call it before other code changes the volume.
  void forget() noexcept;

  /// Pitch of the volume, mm.
  double pitch() const;

  /// Index of a grid, and index of a tile in it.
  struct Place {
    std::uint32_t grid, tile;
    friend bool operator==(const Place&, const Place&) = default;
  };
  /// The tiles that the last call of `move`, `publish` or `publish_part` replaced.
  std::span<const Place> replaced() const;

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace riffler::sweep
