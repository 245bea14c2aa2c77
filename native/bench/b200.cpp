// Memory and time of B200 with a ball, from the block to its mesh, in a process without Python. Usage: riffler_b200
// PITCH DIRECTIONS; prints JSON.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "bench/process.hpp"
#include "bench/scenes.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/sweep/carve.hpp"

int main(int argc, char** argv) {
  using namespace riffler;
  if (argc != 3) {
    std::fputs("riffler_b200 PITCH DIRECTIONS\n", stderr);
    return 2;
  }
  try {
    const bench::NamedCutter ball = bench::named_cutters().front();
    Volume volume = Volume::block({{Vec3(0.0), bench::kBlock}, std::strtod(argv[1], nullptr), argv[2]});
    const bench::Stopwatch carving;
    sweep::carve(volume, ball.tool, bench::path(ball.centre_height, false), {});
    const double carve_s = carving.wall();
    const bench::Stopwatch meshing;
    const Mesh mesh = marching::to_mesh(volume);
    std::printf("{\"carve_s\": %.9g, \"mesh_s\": %.9g, \"triangles\": %zu, \"peak_bytes\": %.0f}\n", carve_s,
                meshing.wall(), mesh.triangles.size(), bench::peak_bytes());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "riffler_b200: %s\n", e.what());
    return 1;
  }
}
