// Whole files in and out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace riffler {

/// The file's bytes. FormatError with the base name where it cannot be opened or read.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path);

/// A file that is written beside `path`, and gone again unless `commit` renames it. std::runtime_error with the base
/// name and the system's reason where it cannot be.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& path);
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  void write(std::span<const std::uint8_t> bytes);
  void commit();  // once

 private:
  std::filesystem::path path_;
  std::string name_;
  int fd_ = -1;
  bool done_ = false;
};

/// Writes beside `path` and renames, so that a file of this name is always whole: the old one or the new one.
/// std::runtime_error with the base name and the system's reason where it cannot.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace riffler
