// Journals of this folder, replayed, and what comes out as one number.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "riffler/session/journal_file.hpp"
#include "riffler/session/replay.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::scenes {

/// A named cutter from its JSON text, which has no other parts here.
inline Tool read_tool(const std::string& json) {
  std::map<std::string, std::string> values;
  const std::regex entry(R"re("(\w+)":\s*"?([^",}]+)"?)re");
  for (std::sregex_iterator it(json.begin(), json.end(), entry), end; it != end; ++it) values[(*it)[1]] = (*it)[2];
  const tool::CutterShape* shape = tool::find_cutter_shape(values.at("kind"));
  if (!shape) throw std::invalid_argument("scenes have no cutter '" + values.at("kind") + "'");
  std::vector<double> sizes;
  for (const tool::CutterSize& size : shape->sizes) {
    const std::string& text = values.at(size.name);
    sizes.push_back(size.unit == tool::SizeUnit::Flag ? text == "true" : std::stod(text));
  }
  return make_cutter(*shape, sizes);
}

inline Volume replay(const std::filesystem::path& path) {
  const session::Journal journal = session::read_journal(path);
  std::map<int, Tool> tools;
  for (const auto& [number, json] : journal.tools()) tools.emplace(number, read_tool(json));
  return session::replay(journal, tools, path.parent_path());
}

/// FNV-1a (Fowler, Noll and Vo) over the spans of all rays, tile by tile, and where each ray's begin.
inline std::uint64_t hash(const Volume& volume) {
  std::uint64_t h = 0xCBF29CE484222325;
  const auto add = [&](const void* data, std::size_t size) {
    for (std::size_t k = 0; k < size; ++k) h = (h ^ static_cast<const unsigned char*>(data)[k]) * 0x100000001B3;
  };
  for (const dexel::Grid& grid : volume.grids())
    for (std::size_t t = 0; t < grid.tile_count(); ++t) {
      const dexel::Tile& tile = grid.tile(t);
      add(tile.offset.data(), tile.offset.size() * sizeof tile.offset[0]);
      for (const dexel::Span& s : tile.spans) add(&s.near, sizeof s.near), add(&s.far, sizeof s.far);
    }
  return h;
}

/// One line of hashes.txt: name, hash, spans, volume.
inline std::string describe(const std::string& name, const Volume& volume) {
  std::size_t spans = 0;
  for (const dexel::Grid& grid : volume.grids()) spans += grid.span_count();
  std::ostringstream out;
  out << name << " " << std::hex << std::setw(16) << std::setfill('0') << hash(volume) << std::dec << " " << spans
      << " " << std::setprecision(12) << volume.volume();
  return out.str();
}

}  // namespace riffler::scenes
