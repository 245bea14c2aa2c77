// A verification whose slabs are simulated elsewhere: prepares the packets to send and accepts the results.
#pragma once

#include "verify/slab_packets.hpp"
#include "verify/slab_run.hpp"

namespace riffler::verify {

/// Call sequence: `add` for every chunk of the program; a SlabWorker for every slab that has moves; `finish`. The
/// report is bit-identical to that of SlabRun::feed. Keeps 24 bytes per row (32 more for feed moves with a stopped
/// spindle) and the results of slabs; the caller keeps the moves.
class VerifyPlan {
 public:
  /// Throws std::invalid_argument naming the argument.
  explicit VerifyPlan(VerifyArguments arguments, const Progress& progress = {});

  struct Share {
    std::size_t slab;
    std::size_t moves;
    std::vector<std::uint8_t> packet;
  };
  /// The chunk's moves for every slab that they can touch, in ascending slab order. Throws as SlabRun::feed. After an
  /// error or Cancelled this object cannot be used any more.
  std::vector<Share> add(const nc::Program& chunk, const Progress& progress = {});

  /// The packet from which a SlabWorker is made; after the last chunk.
  std::vector<std::uint8_t> context() const;
  /// The current state of the slab: as in the stock, or after the results accepted so far.
  std::vector<std::uint8_t> task(std::size_t slab) const;
  /// Accepts a result of slab `slab` for all its moves or for the next of them; `last`: there are no more. Slabs may
  /// come in any order; their volumes are kept until the slabs before them have arrived. Throws FormatError for a
  /// damaged result, std::invalid_argument for one of another slab, and then changes nothing.
  void accept(std::size_t slab, std::span<const std::uint8_t> result, bool last);
  /// Throws std::logic_error if slabs are missing.
  VerifyReport finish(const Progress& progress = {});

 private:
  std::vector<Share> shares_of(const Moves& moves, const Progress& progress);
  void check_slab(std::size_t slab) const;
  void check_result(std::size_t slab, const SlabResult& result) const;
  void merge_finished();

  SlabRun run_;
  std::vector<std::uint8_t> open_;  // per slab: whether a result is missing
  std::size_t merged_ = 0;          // number of slabs whose volumes are added to the rows
};

}  // namespace riffler::verify
