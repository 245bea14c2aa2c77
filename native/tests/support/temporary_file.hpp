// A file of its own for a test, gone after it.
#pragma once

#include <filesystem>
#include <string>

#include "base/own_thread.hpp"

namespace riffler::test {

struct TemporaryFile {
  std::filesystem::path path;
  explicit TemporaryFile(const std::string& name)
      : path(std::filesystem::temp_directory_path() /
             ("riffler_" + std::to_string(base::process_number()) + "_" + name)) {
    std::filesystem::remove(path);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove(path); }
};

}  // namespace riffler::test
