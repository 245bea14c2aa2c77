// A rival: OpenVDB's volumeToMesh of a field that other rivals mesh too. Usage:
//   riffler_openvdb_mesh FIELD NX NY NZ PITCH X Y Z THREADS REPEATS MESH [ADAPTIVITY]
// FIELD: float32, z fastest; its first value belongs to (X, Y, Z). Keeps the narrow band of 3 voxels, as in a level
// set. Writes MESH as MESH.vertices (float32), MESH.quads and MESH.triangles (int32), and prints JSON. ADAPTIVITY:
// OpenVDB's, from 0 (none, the default) to 1.
#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <openvdb/version.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/process.hpp"

namespace {

using openvdb::Coord;

openvdb::FloatGrid::Ptr narrow_band(std::istream& in, const Coord& size, double pitch, const openvdb::Vec3d& origin) {
  const auto band = static_cast<float>(3 * pitch);
  auto grid = openvdb::FloatGrid::create(band);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  auto transform = openvdb::math::Transform::createLinearTransform(pitch);
  transform->postTranslate(origin);
  grid->setTransform(transform);
  auto accessor = grid->getAccessor();
  std::vector<float> row(static_cast<std::size_t>(size.z()));
  for (int i = 0; i < size.x(); ++i)
    for (int j = 0; j < size.y(); ++j) {
      in.read(reinterpret_cast<char*>(row.data()), static_cast<std::streamsize>(row.size() * sizeof(float)));
      if (!in) throw std::runtime_error("the field is too short");
      for (int k = 0; k < size.z(); ++k)
        if (const float value = row[static_cast<std::size_t>(k)]; std::abs(value) < band)
          accessor.setValue(Coord(i, j, k), value);
    }
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

template <class T>
void write(const std::string& path, const std::vector<T>& items) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(items.data()), static_cast<std::streamsize>(items.size() * sizeof(T)));
  if (!out) throw std::runtime_error("cannot write " + path);
}

int run(char** argv, double adaptivity) {
  const auto number = [&](int k) { return std::strtod(argv[k], nullptr); };
  const auto whole = [&](int k) { return static_cast<int>(number(k)); };
  openvdb::initialize();
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(whole(9)));
  std::ifstream in(argv[1], std::ios::binary);
  const auto grid = narrow_band(in, {whole(2), whole(3), whole(4)}, number(5), {number(6), number(7), number(8)});
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  std::vector<double> wall, cpu;
  for (int n = 0; n < whole(10); ++n) {
    const riffler::bench::Stopwatch watch;
    openvdb::tools::volumeToMesh(*grid, points, triangles, quads, 0.0, adaptivity);
    wall.push_back(watch.wall()), cpu.push_back(watch.cpu());
  }
  write(std::string(argv[11]) + ".vertices", points);
  write(std::string(argv[11]) + ".quads", quads);
  write(std::string(argv[11]) + ".triangles", triangles);
  std::printf("{\"version\": \"%s\", \"wall_s\": %.9g, \"cpu_s\": %.9g, \"triangles\": %zu, \"peak_bytes\": %.0f}\n",
              OPENVDB_LIBRARY_VERSION_STRING, riffler::bench::median(wall), riffler::bench::median(cpu),
              triangles.size() + 2 * quads.size(), riffler::bench::peak_bytes());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 12 && argc != 13) {
    std::fputs("riffler_openvdb_mesh FIELD NX NY NZ PITCH X Y Z THREADS REPEATS MESH [ADAPTIVITY]\n", stderr);
    return 2;
  }
  try {
    return run(argv, argc > 12 ? std::strtod(argv[12], nullptr) : 0.0);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "riffler_openvdb_mesh: %s\n", e.what());
    return 1;
  }
}
