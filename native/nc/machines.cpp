#include "nc/machines.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include "geom/io.hpp"
#include "nc/description.hpp"
#include "nc/shipped_machines.hpp"

namespace riffler {

namespace {

namespace fs = std::filesystem;

fs::path settings_folder() {
  const auto variable = [](const char* name) { return std::getenv(name); };
#ifdef _WIN32
  if (const char* folder = variable("APPDATA"); folder && *folder) return folder;
#else
  if (const char* folder = variable("XDG_CONFIG_HOME"); folder && *folder) return folder;
  if (const char* home = variable("HOME"); home && *home) return fs::path(home) / ".config";
#endif
  return {};
}

const ShippedMachine* shipped(std::string_view name) {
  const auto all = shipped_machines();
  const auto at = std::find_if(all.begin(), all.end(), [&](const ShippedMachine& m) { return m.name == name; });
  return at == all.end() ? nullptr : &*at;
}

std::string text_of(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  return {bytes.begin(), bytes.end()};
}

/// The user's files, in the order of their folders and names; of two with one name the first.
std::vector<fs::path> own_files() {
  std::vector<fs::path> out;
  for (const fs::path& folder : own_machine_folders()) {
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

std::string own_summary(const fs::path& path) {
  if (shipped(path.stem().string()))
    return "not used: a machine of this name comes with Riffler; rename " + path.string();
  try {
    return machine_summary(text_of(path), path.filename().string());
  } catch (const std::exception& e) {
    return std::string("cannot be read: ") + e.what();
  }
}

std::unique_ptr<Machine> from_file(const fs::path& path, OptionReader& options) {
  const std::string file = path.filename().string();
  return std::make_unique<Machine>(describe_machine(text_of(path), file, path.stem().string(), options));
}

}  // namespace

std::vector<fs::path> own_machine_folders() {
  std::vector<fs::path> out;
#ifdef _WIN32
  constexpr char kApart = ';';
#else
  constexpr char kApart = ':';
#endif
  if (const char* folders = std::getenv("RIFFLER_MACHINES")) {
    std::string_view rest(folders);
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(kApart), rest.size());
      if (end > 0) out.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  if (const fs::path settings = settings_folder(); !settings.empty()) out.push_back(settings / "riffler" / "machines");
  return out;
}

std::vector<MachineEntry> machines() {
  std::vector<MachineEntry> out;
  for (const ShippedMachine& m : shipped_machines())
    out.push_back({std::string(m.name), machine_summary(m.toml, std::string(m.name) + ".toml")});
  for (const fs::path& path : own_files())
    if (!shipped(path.stem().string()))
      out.push_back({path.stem().string(), own_summary(path)});
    else
      out.push_back({path.filename().string(), own_summary(path)});
  return out;
}

std::unique_ptr<Machine> make_machine(std::string_view name, OptionReader& options) {
  if (const ShippedMachine* found = shipped(name))
    return std::make_unique<Machine>(
        describe_machine(found->toml, std::string(name) + ".toml", std::string(name), options));
  if (name.ends_with(".toml")) return from_file(fs::path(name), options);
  std::string known;
  for (const ShippedMachine& m : shipped_machines()) known += (known.empty() ? "" : ", ") + std::string(m.name);
  for (const fs::path& path : own_files()) {
    if (path.stem() == name) return from_file(path, options);
    known += ", " + path.stem().string();
  }
  throw std::invalid_argument("unknown " + options.owner() + "; known: " + known +
                              ", or the path of a .toml file that describes your machine");
}

}  // namespace riffler
