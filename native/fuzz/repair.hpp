// Corrects lengths and checksums after a mutation, so that the mutated bytes reach the reader behind the checks.
#pragma once

#include <cstdint>
#include <vector>

namespace riffler::fuzz {

// Each leaves bytes unchanged that are too short for the format.
void repair_volume(std::vector<std::uint8_t>& bytes);
void repair_program(std::vector<std::uint8_t>& bytes);
void repair_journal(std::vector<std::uint8_t>& bytes);
void repair_packet(std::vector<std::uint8_t>& bytes);

}  // namespace riffler::fuzz
