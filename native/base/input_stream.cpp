#include "base/input_stream.hpp"

#include <sys/types.h>

namespace riffler::base {

InputStream open_input(const std::filesystem::path& path) {
  return InputStream(std::fopen(path.c_str(), "rb"));
}

bool seek_input(std::FILE* file, std::uint64_t at) {
  return ::fseeko(file, static_cast<off_t>(at), SEEK_SET) == 0;
}

}  // namespace riffler::base
