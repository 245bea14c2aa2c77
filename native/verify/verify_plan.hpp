// A verification whose slabs are simulated elsewhere: what has to be sent, and what becomes of what comes back.
#pragma once

#include "verify/slab_packets.hpp"
#include "verify/slab_run.hpp"

namespace riffler::verify {

/// First the program goes through `add`, chunk by chunk; then every slab that has moves goes to a SlabWorker; then
/// `finish`. The report is that of SlabRun::feed, bit for bit. Keeps 24 bytes a row (feed moves under a spindle that
/// stands: 32 more) and what slabs have found; moves go to the caller.
class VerifyPlan {
 public:
  /// Throws std::invalid_argument naming the argument.
  explicit VerifyPlan(VerifyArguments arguments, const Progress& progress = {});

  struct Share {
    std::size_t slab;
    std::size_t moves;
    std::vector<std::uint8_t> packet;
  };
  /// The chunk's moves, for every slab that they can touch, slabs ascending. Throws as SlabRun::feed. After an error or
  /// Cancelled this cannot be used any more.
  std::vector<Share> add(const nc::Program& chunk, const Progress& progress = {});

  /// What a SlabWorker is made of, once all chunks are there.
  std::vector<std::uint8_t> context() const;
  /// The slab as it stands: as it came from the stock, or after the results accepted so far.
  std::vector<std::uint8_t> task(std::size_t slab) const;
  /// Takes a result of slab `slab` for all its moves, or for the next of them; `last`: there are no more. Slabs come in
  /// any order, but what one waits for the slabs before it is kept until then. FormatError for a damaged result,
  /// std::invalid_argument for one that is not this slab's; nothing is changed then.
  void accept(std::size_t slab, std::span<const std::uint8_t> result, bool last);
  /// std::logic_error where slabs are missing.
  VerifyReport finish(const Progress& progress = {});

 private:
  std::vector<Share> shares_of(const Moves& moves, const Progress& progress);
  void check_slab(std::size_t slab) const;
  void check_result(std::size_t slab, const SlabResult& result) const;
  void merge_finished();

  SlabRun run_;
  std::vector<std::uint8_t> open_;  // of each slab: whether a result is missing
  std::size_t merged_ = 0;          // slabs whose volumes have been added to the rows
};

}  // namespace riffler::verify
