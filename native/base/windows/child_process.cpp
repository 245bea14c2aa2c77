#include "base/child_process.hpp"

#include <system_error>

namespace riffler::base {

ChildProcess::ChildProcess(const std::string& file, const std::vector<std::string>&, int) {
  throw std::system_error(std::make_error_code(std::errc::function_not_supported), file);
}

ChildProcess::~ChildProcess() = default;

bool ChildProcess::ended() noexcept {
  return true;
}

bool ChildProcess::wait(double) noexcept {
  return true;
}

std::string ChildProcess::end_text() const {
  return "it was never started";
}

}  // namespace riffler::base
