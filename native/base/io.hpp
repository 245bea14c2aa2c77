// Reads and writes whole files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace riffler::base {

/// Throws FormatError for a folder, a pipe or a device, which might never end.
void check_regular(const std::filesystem::path& path);

/// The file's bytes. Throws FormatError with the base name if the file cannot be opened or read.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path);

/// Writes with an AtomicFileWriter, so a file of this name is always complete: the old one or the new one.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace riffler::base
