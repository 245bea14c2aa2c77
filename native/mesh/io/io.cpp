#include "riffler/mesh/io/io.hpp"

#include <stdexcept>
#include <string>

#include "base/atomic_file.hpp"
#include "base/io.hpp"
#include "base/path_text.hpp"
#include "mesh/io/obj.hpp"
#include "mesh/io/ply.hpp"
#include "mesh/io/scan.hpp"
#include "mesh/io/stl.hpp"

namespace riffler::mesh {

namespace {

struct Format {
  const char* extension;
  Mesh (*from)(std::span<const std::uint8_t>, const std::string&, const Progress&);
  void (*put)(const Mesh&, const PutBytes&);
};

void put_obj(const Mesh& mesh, const PutBytes& put) {
  put(to_obj(mesh), 1);
}

void put_ply(const Mesh& mesh, const PutBytes& put) {
  put(to_ply(mesh), 1);
}

Mesh stl(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress) {
  base::report(progress, 0);
  return from_stl(bytes, name);
}

constexpr Format kFormats[] = {{".stl", stl, put_stl}, {".obj", from_obj, put_obj}, {".ply", from_ply, put_ply}};

const Format& format_of(const std::filesystem::path& path) {
  const std::string extension = base::path_text(path.extension());
  for (const Format& format : kFormats)
    if (equal_ignoring_case(extension, format.extension)) return format;
  throw std::invalid_argument(base::file_name(path) +
                              ": a mesh file ends in .stl, .obj or .ply (from Python also .3mf), not in " +
                              in_quotes(extension));
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path, const Progress& progress) {
  const Format& format = format_of(path);
  return format.from(base::read_file(path), base::file_name(path), progress);
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const Progress& progress) {
  const Format& format = format_of(path);
  base::report(progress, 0);
  base::AtomicFileWriter file(path);
  format.put(mesh, [&](std::span<const std::uint8_t> bytes, double share) {
    file.write(bytes);
    base::report(progress, share);
  });
  file.commit();
}

}  // namespace riffler::mesh
