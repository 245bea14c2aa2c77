// UTF-8 to the UTF-16 of Windows' functions and back, and the texts of its errors.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace riffler::base {

std::wstring to_wide(std::string_view text);
/// Unpaired surrogates, which names of files may have, become U+FFFD.
std::string from_wide(std::wstring_view text);

/// The path that Windows' functions take also beyond 260 characters: absolute, with the prefix \\?\ where it is long.
std::wstring long_path(const std::filesystem::path& path);

/// GetLastError() of the calling thread.
std::uint32_t last_error() noexcept;
/// The system's text for an error, without its full stop.
std::string error_text(std::uint32_t error);

}  // namespace riffler::base
