// Lengths and checksums made right after a mutation, so that it reaches the reader behind them.
#pragma once

#include <cstdint>
#include <vector>

namespace riffler::fuzz {

// Each leaves bytes alone that are too short for what it looks for.
void repair_volume(std::vector<std::uint8_t>& bytes);
void repair_program(std::vector<std::uint8_t>& bytes);
void repair_journal(std::vector<std::uint8_t>& bytes);
void repair_packet(std::vector<std::uint8_t>& bytes);

}  // namespace riffler::fuzz
