// The .rvol file format: versioned, checksummed, compressed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// Converts a volume to the file's bytes and back. `name` appears in messages. Throws FormatError naming the byte where
/// the data is wrong (magic, version, checksum, order of spans, truncation). Checks the memory needed before it
/// allocates.
std::vector<std::uint8_t> to_bytes(const Volume& volume, const Progress& progress = {});
Volume from_bytes(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress = {});

/// Saves and loads a file. Saving writes a temporary file and renames it, so the file is complete or absent.
void save(const Volume& volume, const std::filesystem::path& path, const Progress& progress = {});
Volume load(const std::filesystem::path& path, const Progress& progress = {});

}  // namespace riffler::dexel
