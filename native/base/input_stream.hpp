// Files larger than memory, read in parts.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace riffler::base {

struct CloseStream {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using InputStream = std::unique_ptr<std::FILE, CloseStream>;

/// Opens a file to read its bytes. Throws FormatError with the base name and the reason.
InputStream open_input(const std::filesystem::path& path);
/// Goes to byte `at`, which may lie beyond 2 GiB. False for a file that cannot be read again, such as a pipe.
bool seek_input(std::FILE* file, std::uint64_t at);

}  // namespace riffler::base
