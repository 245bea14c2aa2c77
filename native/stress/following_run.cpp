#include "stress/following_run.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "riffler/marching/mesher.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/mesh_scenes.hpp"
#include "stress/random.hpp"

namespace riffler::stress {

namespace {

constexpr std::uint64_t kFollowingStream = 0x666F6C6C;
constexpr long kLongestSeries = 50;

/// Changes the volume by a stroke of a cutter through the box, or by a patch of rays that contradict those of the other
/// directions.
void change(Volume& volume, Random& random) {
  const Box3 box = volume.frame().box;
  const Vec3 size = box.upper - box.lower;
  if (random.one_in(6)) {
    dexel::Grid& grid = volume.grids()[static_cast<std::size_t>(random.below(static_cast<int>(volume.grids().size())))];
    const int i0 = random.below(grid.nu()), j0 = random.below(grid.nv());
    const int i1 = std::min(grid.nu() - 1, i0 + random.below(9)), j1 = std::min(grid.nv() - 1, j0 + random.below(9));
    change_rays(grid, i0, i1, j0, j1, [&] { return spans_at_random(random, grid, 0.8, true); });
    volume.touch();
    return;
  }
  const double d = 0.2 * std::min({size.x, size.y, size.z}), length = 4 * glm::length(size);
  const Tool tools[] = {cutters::ball(d, length), cutters::flat(0.8 * d, length),
                        cutters::taper(0.2 * d, 0.3, 1.5 * d, length)};
  Pose from{box.lower + Vec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)) * size,
            random.direction()};
  Pose to = from;
  to.tip += random.uniform(0, 2 * d) * random.direction();
  sweep::carve(volume, tools[random.below(3)], std::array{from, to});
}

using Corners = std::array<float, 9>;

void add_corners(const marching::MeshPatch& patch, std::vector<Corners>& out) {
  for (const Vec3i& t : patch.triangles) {
    Corners& corners = out.emplace_back();
    for (int c = 0; c < 3; ++c)
      for (int a = 0; a < 3; ++a) corners[3 * c + a] = patch.vertices[t[c]][a];
  }
}

/// Whether the patches kept so far form the mesh, triangle by triangle.
bool same(const std::map<std::size_t, marching::MeshPatch>& patches, const Mesh& mesh) {
  std::vector<Corners> kept, expected;
  for (const auto& [brick, patch] : patches) add_corners(patch, kept);
  marching::MeshPatch whole;
  whole.triangles = mesh.triangles;
  for (const Vec3& v : mesh.vertices) whole.vertices.emplace_back(v);
  add_corners(whole, expected);
  std::sort(kept.begin(), kept.end());
  std::sort(expected.begin(), expected.end());
  return kept == expected;
}

}  // namespace

FollowedSeries follow_series(std::uint64_t seed, std::uint64_t number, long strokes, bool tolerant) {
  Random random(seed, kFollowingStream, number);
  const double pitch = 0.25, tolerance = pitch * std::array{0.02, 0.1, 0.4, 4.0}[random.below(4)];
  const Vec3 size(random.uniform(5, 34), random.uniform(5, 18), random.uniform(5, 12));
  Volume volume = Volume::block({{Vec3(0), size}, pitch, random.one_in(4) ? "z" : "xyz"});
  FollowedSeries out;
  marching::Mesher full(volume), mesher(volume, tolerance);
  std::map<std::size_t, marching::MeshPatch> patches;
  for (const std::size_t n : mesher.patches()) patches[n] = mesher.patch(n);
  const auto fail = [&](const char* what) {
    out.problem = std::string(what) + " at stroke " + std::to_string(out.strokes) + " of series " +
                  std::to_string(number) + ", seed " + std::to_string(seed);
    return out;
  };
  for (; out.strokes < std::min(strokes, kLongestSeries);) {
    const Volume before = volume;
    change(volume, random);
    if (random.one_in(8)) volume = before;  // undo
    ++out.strokes;
    full.update(volume);
    const Mesh all = marching::to_mesh(volume), followed = full.mesh();
    if (followed.vertices != all.vertices || followed.triangles != all.triangles)
      return fail("without a tolerance, the mesher's mesh differs from to_mesh's");
    if (!tolerant) continue;
    for (const std::size_t n : mesher.update(volume)) patches[n] = mesher.patch(n);
    const Mesh expected = marching::to_mesh(volume, tolerance), mesh = mesher.mesh();
    if (mesh.vertices != expected.vertices || mesh.triangles != expected.triangles)
      return fail("the mesher's mesh differs from to_mesh's");
    if (!same(patches, expected)) return fail("the patches differ from the mesh");
  }
  if (!tolerant) return out;
  const Mesh fresh = marching::Mesher(volume, tolerance).mesh(), mesh = mesher.mesh();
  if (mesh.vertices != fresh.vertices || mesh.triangles != fresh.triangles)
    return fail("the mesher's mesh differs from a new mesher's");
  return out;
}

std::string follow_strokes(std::uint64_t seed, long strokes, const std::function<bool(long)>& progress) {
  long made = 0;
  for (std::uint64_t number = 0; made < strokes; ++number) {
    const FollowedSeries series = follow_series(seed, number, strokes - made);
    if (!series.problem.empty()) return series.problem;
    made += series.strokes;
    if (progress && !progress(made)) break;
  }
  return {};
}

}  // namespace riffler::stress
