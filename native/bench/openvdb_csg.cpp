// A rival: subtracts B200's balls one by one from a narrow-band level set with OpenVDB's CSG, then meshes it. Balls,
// because OpenVDB has no swept volume of a ball. Usage: riffler_openvdb_csg PITCH; prints JSON.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/LevelSetMeasure.h>
#include <openvdb/tools/LevelSetPlatonic.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <openvdb/version.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "bench/scenes.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  using namespace riffler;
  const float pitch = argc > 1 ? std::strtof(argv[1], nullptr) : 0.25f;
  openvdb::initialize();
  const auto transform = openvdb::math::Transform::createLinearTransform(pitch);
  const openvdb::BBoxd box({0, 0, 0}, {bench::kBlock.x, bench::kBlock.y, bench::kBlock.z});
  auto block = openvdb::tools::createLevelSetBox<openvdb::FloatGrid>(box, *transform);
  const double before = openvdb::tools::levelSetVolume(*block);  // its edges are rounded
  std::vector<double> times;
  for (int k = 0; k <= bench::kMoves; ++k) {
    const Vec3 c = bench::centre(k);
    const openvdb::Vec3f at(static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z));
    const auto start = Clock::now();
    auto ball = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(3.0f, at, pitch);
    openvdb::tools::csgDifference(*block, *ball);
    times.push_back(seconds_since(start));
  }
  std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
  const auto start = Clock::now();
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*block, points, quads);
  const double meshing = seconds_since(start);
  std::printf(
      "{\"version\": \"%s\", \"median\": %.9g, \"volume_before\": %.9g, \"volume\": %.9g, \"triangles\": %zu, "
      "\"mesh\": %.9g}\n",
      OPENVDB_LIBRARY_VERSION_STRING, times[times.size() / 2], before, openvdb::tools::levelSetVolume(*block),
      2 * quads.size(), meshing);
}
