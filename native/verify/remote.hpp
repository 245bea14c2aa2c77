// Slabs simulated elsewhere: what a worker of a cluster does.
#pragma once

#include <optional>

#include "verify/slab_packets.hpp"

namespace riffler::verify {

/// Simulates slabs whose material arrives with them; of the stock, the fixtures and the part's volume nothing is made
/// but rays without material. Calls may run on several threads at once, each of them on one.
class SlabWorker {
 public:
  /// A packet of VerifyPlan::context. FormatError for a damaged one.
  explicit SlabWorker(std::span<const std::uint8_t> context);

  /// `task`: of VerifyPlan::task; `moves`: of VerifyPlan::add, all for this slab, in order. Returns what
  /// VerifyPlan::accept takes: the same bytes wherever and whenever it is run. FormatError where one is damaged,
  /// std::invalid_argument where it is of another verification.
  std::vector<std::uint8_t> run(std::span<const std::uint8_t> task,
                                std::span<const std::span<const std::uint8_t>> moves) const;

 private:
  const dexel::Grid& grid_of(const SlabTask& task) const;

  SlabContext context_;
  std::vector<ToolShapes> shapes_;
  std::vector<std::vector<dexel::Grid>> grids_;  // of the frames; empty
  std::optional<PartSurface> surface_;
};

}  // namespace riffler::verify
