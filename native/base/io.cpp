#include "base/io.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "base/atomic_file.hpp"
#include "riffler/base/error.hpp"

namespace riffler::base {

namespace fs = std::filesystem;

void check_regular(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (fs::is_directory(status)) throw FormatError(path.filename().string(), "", "is a directory, not a file");
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw FormatError(path.filename().string(), "", "is a pipe or a device, not a file");
}

std::vector<std::uint8_t> read_file(const fs::path& path) {
  const std::string name = path.filename().string();
  check_regular(path);
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw FormatError(name, "", std::string("cannot be opened: ") + std::strerror(errno));
  const std::streamoff size = in.tellg();
  std::vector<std::uint8_t> bytes(size > 0 ? static_cast<std::size_t>(size) : 0);
  in.seekg(0);
  if (!bytes.empty() && !in.read(reinterpret_cast<char*>(bytes.data()), size))
    throw FormatError(name, "byte " + std::to_string(in.gcount()), "cannot be read further");
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
