#include "riffler/base/descriptions.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include "base/environment.hpp"
#include "base/io.hpp"
#include "base/nearest_word.hpp"
#include "base/path_text.hpp"

namespace riffler::base {

namespace {

namespace fs = std::filesystem;

fs::path settings_folder() {
  const auto folder = [](const char* name) { return text_path(environment(name).value_or("")); };
#ifdef _WIN32
  return folder("APPDATA");
#else
  if (fs::path own = folder("XDG_CONFIG_HOME"); !own.empty()) return own;
  const fs::path home = folder("HOME");
  return home.empty() ? home : home / ".config";
#endif
}

const ShippedText* shipped(const DescriptionCatalog& shelf, std::string_view name) {
  const auto at =
      std::find_if(shelf.shipped.begin(), shelf.shipped.end(), [&](const ShippedText& s) { return s.name == name; });
  return at == shelf.shipped.end() ? nullptr : &*at;
}

std::string text_of(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  return {bytes.begin(), bytes.end()};
}

/// The user's files, ordered by folder and name. If two have the same name, the first counts.
std::vector<fs::path> own_files(const DescriptionCatalog& shelf) {
  std::vector<fs::path> out;
  for (const fs::path& folder : own_folders(shelf)) {
    std::error_code error;
    std::vector<fs::path> here;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
      if (at->path().extension() == ".toml") here.push_back(at->path());
    std::sort(here.begin(), here.end());
    for (const fs::path& path : here)
      if (std::none_of(out.begin(), out.end(), [&](const fs::path& o) { return o.stem() == path.stem(); }))
        out.push_back(path);
  }
  return out;
}

DescriptionText read(const fs::path& path) {
  return {path_text(path.stem()), file_name(path), text_of(path)};
}

std::string own_summary(const DescriptionCatalog& shelf, const fs::path& path) {
  if (shipped(shelf, path_text(path.stem())))
    return std::string("not used: a ") + shelf.kind + " of this name comes with Riffler; rename " + path_text(path);
  try {
    return shelf.summary(text_of(path), file_name(path));
  } catch (const std::exception& e) {
    return std::string("cannot be read: ") + e.what();
  }
}

}  // namespace

std::vector<fs::path> own_folders(const DescriptionCatalog& shelf) {
  std::vector<fs::path> out;
#ifdef _WIN32
  constexpr char kApart = ';';
#else
  constexpr char kApart = ':';
#endif
  if (const char* folders = std::getenv(shelf.variable)) {
    std::string_view rest(folders);
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(kApart), rest.size());
      if (end > 0) out.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  if (const fs::path settings = settings_folder(); !settings.empty())
    out.push_back(settings / "riffler" / shelf.folder);
  return out;
}

std::vector<DescriptionEntry> list_descriptions(const DescriptionCatalog& shelf) {
  std::vector<DescriptionEntry> out;
  for (const ShippedText& s : shelf.shipped)
    out.push_back({std::string(s.name), shelf.summary(s.toml, std::string(s.name) + ".toml")});
  for (const fs::path& path : own_files(shelf)) {
    const bool hidden = shipped(shelf, path_text(path.stem()));
    out.push_back({path_text(hidden ? path.filename() : path.stem()), own_summary(shelf, path)});
  }
  return out;
}

DescriptionText find_description(const DescriptionCatalog& shelf, std::string_view name, const std::string& what) {
  if (const ShippedText* found = shipped(shelf, name))
    return {std::string(name), std::string(name) + ".toml", std::string(found->toml)};
  if (name.ends_with(".toml")) return read(text_path(std::string(name)));
  std::vector<std::string> names;
  for (const ShippedText& s : shelf.shipped) names.emplace_back(s.name);
  for (const fs::path& path : own_files(shelf)) {
    if (path_text(path.stem()) == name) return read(path);
    names.push_back(path_text(path.stem()));
  }
  std::string known;
  for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
  const std::string hint = nearest_word_hint(name, names);
  throw std::invalid_argument("unknown " + what + hint + (hint.empty() ? "; " : " ") + "known: " + known +
                              ", or the path of a .toml file that describes your " + shelf.kind);
}

}  // namespace riffler::base
