// The .rvol file: versioned, checksummed, compressed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// The file's bytes, and back. `name` stands in messages. FormatError names the byte where a file is not what it should
/// be (magic, version, checksum, order of spans, truncated); memory is checked before it is allocated.
std::vector<std::uint8_t> to_bytes(const Volume& volume, const Progress& progress = {});
Volume from_bytes(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress = {});

/// Written beside and renamed, so a file is whole or not there.
void save(const Volume& volume, const std::filesystem::path& path, const Progress& progress = {});
Volume load(const std::filesystem::path& path, const Progress& progress = {});

}  // namespace riffler::dexel
