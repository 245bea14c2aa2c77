// Whole files in and out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "geom/progress.hpp"

namespace riffler {

/// The file's bytes. FormatError with the base name where it cannot be opened or read.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path);

/// Writes beside `path` and renames, so that a file of this name is always whole: the old one or the new one.
/// std::runtime_error with the base name and the system's reason where it cannot. Where `progress` cancels, nothing is
/// left.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes, const Progress& progress = {});
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace riffler
