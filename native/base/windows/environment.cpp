#include "base/environment.hpp"

#include <windows.h>

#include "base/windows/wide.hpp"

namespace riffler::base {

std::optional<std::string> environment(const char* name) {
  const std::wstring wide = to_wide(name);
  std::wstring value(256, L'\0');
  while (true) {
    SetLastError(ERROR_SUCCESS);
    const DWORD size = GetEnvironmentVariableW(wide.c_str(), value.data(), static_cast<DWORD>(value.size()));
    if (size == 0 && GetLastError() == ERROR_ENVVAR_NOT_FOUND) return {};
    const bool complete = size < value.size();
    value.resize(size);
    if (complete) return from_wide(value);
  }
}

}  // namespace riffler::base
