#include "base/io.hpp"

#include <cstdio>
#include <string>
#include <system_error>

#include "base/atomic_file.hpp"
#include "base/input_stream.hpp"
#include "base/path_text.hpp"
#include "riffler/base/error.hpp"

namespace riffler::base {

namespace fs = std::filesystem;

void check_regular(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (fs::is_directory(status)) throw FormatError(file_name(path), "", "is a directory, not a file");
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw FormatError(file_name(path), "", "is a pipe or a device, not a file");
}

std::vector<std::uint8_t> read_file(const fs::path& path) {
  const std::string name = file_name(path);
  check_regular(path);
  const InputStream in = open_input(path);
  // The size is a guess, since another file may take the path's name at any time: the open one is read to its end.
  std::error_code unknown;
  const std::uintmax_t size = fs::file_size(path, unknown);
  std::vector<std::uint8_t> bytes;
  std::size_t read = 0;
  do {
    bytes.resize(bytes.empty() ? 1 + static_cast<std::size_t>(unknown ? 0xFFFF : size) : 2 * bytes.size());
    read += std::fread(bytes.data() + read, 1, bytes.size() - read, in.get());
  } while (read == bytes.size());
  if (std::ferror(in.get())) throw FormatError(name, "byte " + std::to_string(read), "cannot be read further");
  bytes.resize(read);
  return bytes;
}

void write_file(const fs::path& path, std::span<const std::uint8_t> bytes) {
  AtomicFileWriter file(path);
  file.write(bytes);
  file.commit();
}

void write_file(const fs::path& path, std::string_view text) {
  write_file(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace riffler::base
