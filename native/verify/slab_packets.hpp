// Packets to and from a worker for a slab.
#pragma once

#include "riffler/geom/pose.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/tool/tool.hpp"
#include "verify/packet.hpp"
#include "verify/slab_job.hpp"

namespace riffler::verify {

/// What all slabs share. Created once per machine.
struct SlabContext {
  std::vector<dexel::Frame> frames;  ///< of the stock, then of the fixtures
  std::vector<Tool> tools;           ///< by index in the toolset
  double reach = 0;                  ///< mm: as for ToolShapes
  double tolerance = 0;              ///< mm
  double gouge_tolerance = 0;
  double top = 0;                    ///< mm: as for Moves
  std::shared_ptr<const Mesh> part;  ///< may be null
};
std::vector<std::uint8_t> to_packet(const SlabContext& context);
SlabContext context_of(std::span<const std::uint8_t> packet);

/// The current state of one slab.
struct SlabTask {
  std::int32_t fixture = -1;
  Slab slab;
  bool probed = false;
  std::uint64_t strikes = 0;  ///< SlabReport::strikes so far
  SlabTiles tiles;
  SlabTiles part;  ///< the part's material; empty without a part, and for fixtures
};
std::vector<std::uint8_t> to_packet(const SlabTask& task);
SlabTask task_of(std::span<const std::uint8_t> packet);

/// Some of the moves that can touch a slab, in ascending rows.
struct SlabMoves {
  std::vector<std::int64_t> row;
  std::vector<std::uint32_t> tool;
  std::vector<std::uint8_t> rapid;
  std::vector<Pose> poses;  ///< two per move
};
/// The moves `chosen` (indices in `moves`). A pose at which one move ends and the next begins is stored once.
std::vector<std::uint8_t> to_packet(const Moves& moves, std::span<const std::uint32_t> chosen);
/// Appends the moves of a packet.
void add_moves(std::span<const std::uint8_t> packet, SlabMoves& moves);

/// The result. Unchanged tiles are null.
struct SlabResult {
  SlabTiles tiles;
  SlabReport report;
  VerifyStats stats;
};
std::vector<std::uint8_t> to_packet(const SlabResult& result);
SlabResult result_of(std::span<const std::uint8_t> packet);

}  // namespace riffler::verify
