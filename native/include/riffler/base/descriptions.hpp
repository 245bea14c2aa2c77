// Where descriptions (of machines, of pens) are found: those that come with Riffler, whose texts cmake/shipped.cmake
// puts into the library, and files of the user's own.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace riffler::base {

struct ShippedText {
  std::string_view name, toml;
};

struct DescriptionEntry {
  std::string name, description;
};

struct DescriptionText {
  std::string name, file, toml;  // file: base name, for messages
};

struct DescriptionCatalog {
  const char* kind;      // "machine"
  const char* variable;  // of the environment: folders, apart as in PATH
  const char* folder;    // in riffler/ of the user's folder for settings
  std::span<const ShippedText> shipped;
  /// Of a text and its file, the line for lists; FormatError.
  std::string (*summary)(std::string_view toml, const std::string& file);
};

/// The folders of `variable`, then the one among the user's settings.
std::vector<std::filesystem::path> own_folders(const DescriptionCatalog& shelf);

/// All of them, ours first, then every *.toml in own_folders(); of a file that cannot be read the description says why.
std::vector<DescriptionEntry> list_descriptions(const DescriptionCatalog& shelf);

/// `name` is one of the list, or the path of a .toml file. Throws std::invalid_argument that names `what` was asked for
/// and the known ones, FormatError where the file cannot be read.
DescriptionText find_description(const DescriptionCatalog& shelf, std::string_view name, const std::string& what);

}  // namespace riffler::base
