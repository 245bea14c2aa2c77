#include "base/input_stream.hpp"

#include <sys/types.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "base/path_text.hpp"
#include "riffler/base/error.hpp"

namespace riffler::base {

InputStream open_input(const std::filesystem::path& path) {
  InputStream out(std::fopen(path.c_str(), "rb"));
  if (!out) throw FormatError(file_name(path), "", std::string("cannot be opened: ") + std::strerror(errno));
  return out;
}

bool seek_input(std::FILE* file, std::uint64_t at) {
  return ::fseeko(file, static_cast<off_t>(at), SEEK_SET) == 0;
}

}  // namespace riffler::base
