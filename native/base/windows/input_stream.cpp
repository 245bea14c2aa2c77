#include "base/input_stream.hpp"

#include <string>

#include "base/path_text.hpp"
#include "base/windows/wide.hpp"
#include "riffler/base/error.hpp"

namespace riffler::base {

InputStream open_input(const std::filesystem::path& path) {
  InputStream out(_wfopen(long_path(path).c_str(), L"rbN"));
  if (!out) throw FormatError(file_name(path), "", "cannot be opened: " + error_text(last_error()));
  return out;
}

bool seek_input(std::FILE* file, std::uint64_t at) {
  return _fseeki64(file, static_cast<long long>(at), SEEK_SET) == 0;
}

}  // namespace riffler::base
