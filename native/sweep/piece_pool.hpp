// The spans of rays with more than two, in an open tile.
#pragma once

#include <cstddef>
#include <cstdint>

#include "riffler/base/block_pool.hpp"
#include "riffler/dexel/span.hpp"
#include "riffler/dexel/tile.hpp"

namespace riffler::sweep {

/// Origins of both ends of a span. An end that a cut has made holds 2 k + t: it arose in step k of the carver's steps
/// at the step's time t (for_each_step), in units of 2^-30. Its normal is computed when the tile is packed, because
/// most ends are cut away before. kStored: the normal is stored.
struct Origins {
  static constexpr double kStored = -1;
  static constexpr double kUnit = 1.0 / (1 << 30);
  double near = kStored, far = kStored;
};

struct Piece {
  dexel::Span span;
  dexel::SpanNormals normals;
  Origins origins;
};

/// One list of pieces per ray. The lists lie in blocks of a size that the memory pool keeps: a tile that grows rough
/// takes one more, where a single array would ask the system for twice as much in the middle of a pen's step.
class PiecePool {
 public:
  struct Place {
    std::uint32_t block = 0, begin = 0, count = 0, room = 0;
    std::uint32_t pair = 0;  // pieces number `pair` and `pair` + 1 are in the tile's planes
  };

  /// Asks for the memory of a first block.
  void reserve();
  /// Empties all lists.
  void clear();
  const Place& at(int ray) const { return places_[static_cast<std::size_t>(ray)]; }
  Piece* pieces(const Place& at) { return blocks_[at.block].data() + at.begin; }
  const Piece* pieces(const Place& at) const { return blocks_[at.block].data() + at.begin; }
  /// The place of a ray, with room for n pieces, which are not there yet if it is new. `used`: a bit for each ray whose
  /// list counts, by rows. If it throws, every ray has what it had.
  Place& room(int ray, std::uint32_t n, const std::uint32_t* used);

 private:
  using Blocks = base::BlockVector<base::BlockVector<Piece>>;
  static constexpr std::uint32_t kBlock = (1U << 15) / sizeof(Piece);

  static Place extend(Blocks& blocks, std::uint32_t room);
  void tidy(const std::uint32_t* used);

  Blocks blocks_;
  base::BlockVector<Place> places_;
  std::size_t held_ = 0, most_ = kBlock;  // pieces in all blocks; as many before they are made tight
};

}  // namespace riffler::sweep
