// Whole files in and out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace riffler::base {

/// FormatError for a folder, a pipe or a device: what comes out of those may never end.
void check_regular(const std::filesystem::path& path);

/// The file's bytes. FormatError with the base name where it cannot be opened or read.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path);

/// By an AtomicFileWriter, so that a file of this name is always whole: the old one or the new one.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace riffler::base
