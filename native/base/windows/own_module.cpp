#include "base/own_module.hpp"

#include <windows.h>

#include <string>

namespace riffler::base {

std::filesystem::path module_folder() {
  constexpr DWORD kFlags = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
  HMODULE module = nullptr;
  if (!GetModuleHandleExW(kFlags, reinterpret_cast<LPCWSTR>(&module_folder), &module)) return {};
  std::wstring path(32768, L'\0');  // the longest that Windows has
  path.resize(GetModuleFileNameW(module, path.data(), static_cast<DWORD>(path.size())));
  return std::filesystem::path(path).parent_path();
}

}  // namespace riffler::base
