// A slab's tiles in a packet.
#pragma once

#include "verify/packet.hpp"
#include "verify/slab.hpp"

namespace riffler::verify {

/// Null tiles stay null. Bits are kept, the tiles' reach among them: what a slab is simulated to does not depend on
/// whether it has travelled.
void put_tiles(PacketWriter& out, const SlabTiles& tiles);
SlabTiles get_tiles(PacketReader& in);

}  // namespace riffler::verify
