// Finds descriptions of machines and pens: those shipped with Riffler, which cmake/shipped.cmake compiles into the
// library, and the user's own files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace riffler::base {

/// One description compiled into the library.
struct ShippedText {
  std::string_view name, toml;
};

/// One line of a list of descriptions.
struct DescriptionEntry {
  std::string name, description;
};

/// The text of one description.
struct DescriptionText {
  std::string name, file, toml;  // file: base name, for messages
};

/// One kind of description and the places it is looked up in.
struct DescriptionCatalog {
  const char* kind;      // for messages: "machine"
  const char* variable;  // environment variable with extra folders, separated as in PATH
  const char* folder;    // folder name inside riffler/ in the user's settings folder
  std::span<const ShippedText> shipped;
  /// Returns a description's line for lists. Throws FormatError.
  std::string (*summary)(std::string_view toml, const std::string& file);
};

/// The folders of the catalog's environment variable, then the folder in the user's settings.
std::vector<std::filesystem::path> own_folders(const DescriptionCatalog& shelf);

/// All descriptions: the shipped ones first, then every *.toml in own_folders(). If a file cannot be read, its
/// description holds the error message.
std::vector<DescriptionEntry> list_descriptions(const DescriptionCatalog& shelf);

/// Looks up `name`: a name from the list, or the path of a .toml file. Throws std::invalid_argument that names `what`
/// and lists the known names, or FormatError if the file cannot be read.
DescriptionText find_description(const DescriptionCatalog& shelf, std::string_view name, const std::string& what);

}  // namespace riffler::base
