#include "base/windows/wide.hpp"

#include <windows.h>

#include <system_error>

namespace riffler::base {

std::wstring to_wide(std::string_view text) {
  const int size = static_cast<int>(text.size());
  std::wstring out(static_cast<std::size_t>(MultiByteToWideChar(CP_UTF8, 0, text.data(), size, nullptr, 0)), L'\0');
  MultiByteToWideChar(CP_UTF8, 0, text.data(), size, out.data(), static_cast<int>(out.size()));
  return out;
}

std::string from_wide(std::wstring_view text) {
  const int size = static_cast<int>(text.size());
  const int bytes = WideCharToMultiByte(CP_UTF8, 0, text.data(), size, nullptr, 0, nullptr, nullptr);
  std::string out(static_cast<std::size_t>(bytes), '\0');
  WideCharToMultiByte(CP_UTF8, 0, text.data(), size, out.data(), bytes, nullptr, nullptr);
  return out;
}

std::wstring long_path(const std::filesystem::path& path) {
  constexpr std::size_t kLongest = 240;  // Windows needs room for a short name in a folder
  std::error_code error;
  const std::wstring whole = std::filesystem::absolute(path, error).lexically_normal().make_preferred().native();
  if (error || whole.size() < kLongest || whole.starts_with(LR"(\\?\)")) return path.native();
  return whole.starts_with(LR"(\\)") ? LR"(\\?\UNC)" + whole.substr(1) : LR"(\\?\)" + whole;
}

std::uint32_t last_error() noexcept {
  return GetLastError();
}

std::string error_text(std::uint32_t error) {
  wchar_t text[512];
  constexpr DWORD kFlags = FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS;
  const DWORD size = FormatMessageW(kFlags, nullptr, error, 0, text, static_cast<DWORD>(std::size(text)), nullptr);
  if (size == 0) return "error " + std::to_string(error) + " of Windows";
  std::string out = from_wide({text, size});
  while (!out.empty() && (out.back() == '\n' || out.back() == '\r' || out.back() == ' ' || out.back() == '.'))
    out.pop_back();
  return out;
}

}  // namespace riffler::base
