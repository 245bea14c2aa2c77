// First inputs: small files of every format that the library writes.
#pragma once

#include <cstdint>
#include <vector>

namespace riffler::fuzz {

using Samples = std::vector<std::vector<std::uint8_t>>;

Samples stl_samples();
Samples obj_samples();
Samples ply_samples();
Samples volume_samples();
Samples program_samples();
Samples journal_samples();
Samples packet_samples();
Samples machine_samples();
Samples pen_samples();

}  // namespace riffler::fuzz
