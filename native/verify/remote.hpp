// Simulation of slabs in a worker process of a cluster.
#pragma once

#include <optional>

#include "verify/slab_packets.hpp"

namespace riffler::verify {

/// Simulates slabs whose material arrives with them. Creates only rays without material for stock, fixtures and part.
/// Calls may run on several threads at once, each call on one thread.
class SlabWorker {
 public:
  /// `context`: a packet of VerifyPlan::context. Throws FormatError for a damaged one.
  explicit SlabWorker(std::span<const std::uint8_t> context);

  /// `task`: from VerifyPlan::task; `moves`: all packets of VerifyPlan::add for this slab, in order. Returns the packet
  /// for VerifyPlan::accept, with the same bytes on every machine. Throws FormatError for a damaged packet,
  /// std::invalid_argument for one of another verification.
  std::vector<std::uint8_t> run(std::span<const std::uint8_t> task,
                                std::span<const std::span<const std::uint8_t>> moves) const;

 private:
  const dexel::Grid& grid_of(const SlabTask& task) const;

  SlabContext context_;
  std::vector<ToolShapes> shapes_;
  std::vector<std::vector<dexel::Grid>> grids_;  // grids of the frames, without material
  std::optional<PartSurface> surface_;
};

}  // namespace riffler::verify
