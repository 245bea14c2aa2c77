#include "mesh/io.hpp"

#include <stdexcept>
#include <string>

#include "geom/io.hpp"
#include "mesh/obj.hpp"
#include "mesh/ply.hpp"
#include "mesh/scan.hpp"
#include "mesh/stl.hpp"

namespace riffler {

namespace {

struct Format {
  const char* extension;
  Mesh (*from)(std::span<const std::uint8_t>, const std::string&);
  std::vector<std::uint8_t> (*to)(const Mesh&);
};

constexpr Format kFormats[] = {{".stl", from_stl, to_stl}, {".obj", from_obj, to_obj}, {".ply", from_ply, to_ply}};

const Format& format_of(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  for (const Format& format : kFormats)
    if (equal_ignoring_case(extension, format.extension)) return format;
  throw std::invalid_argument(path.filename().string() +
                              ": a mesh file ends in .stl, .obj or .ply (from Python also .3mf), not in " +
                              in_quotes(extension));
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  const Format& format = format_of(path);
  return format.from(read_file(path), path.filename().string());
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const Progress& progress) {
  const Format& format = format_of(path);
  report(progress, 0);
  const std::vector<std::uint8_t> bytes = format.to(mesh);
  write_file(path, bytes, part(progress, 0.5, 1));
}

}  // namespace riffler
