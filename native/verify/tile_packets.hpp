// A slab's tiles in a packet.
#pragma once

#include "verify/packet.hpp"
#include "verify/slab.hpp"

namespace riffler::verify {

/// Null tiles stay null. Stores the exact bits, including the tiles' extent, so that the result of a slab is the same
/// with or without the transfer.
void put_tiles(PacketWriter& out, const SlabTiles& tiles);
SlabTiles get_tiles(PacketReader& in);

}  // namespace riffler::verify
