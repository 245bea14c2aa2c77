#include "stress/mesh_run.hpp"

#include <exception>

namespace riffler::stress {

namespace {

constexpr std::size_t kVolumesKept = 100;
constexpr std::uint64_t kMeshStream = 0x6D657368;

}  // namespace

MeshTally MeshResults::total() const {
  MeshTally sum;
  for (const MeshTally& t : scenes) {
    sum.volumes += t.volumes, sum.empty += t.empty;
    sum.triangles += t.triangles, sum.failures += t.failures;
  }
  return sum;
}

MeshScene mesh_scene(std::uint64_t number) {
  return static_cast<MeshScene>(number % static_cast<std::uint64_t>(MeshScene::kCount));
}

Volume mesh_volume(std::uint64_t seed, std::uint64_t number) {
  Random random(seed, kMeshStream, number);
  return draw_volume(random, mesh_scene(number));
}

double mesh_tolerance(const Volume& volume, std::uint64_t number) {
  constexpr std::array kPitches{0.02, 0.1, 0.5, 3.0, 1000.0};
  // Each scene meets each tolerance.
  const std::uint64_t round = number / static_cast<std::uint64_t>(MeshScene::kCount);
  return kPitches[static_cast<std::size_t>(round % kPitches.size())] * volume.frame().pitch;
}

Problem check_volume_number(const MeshOptions& options, std::uint64_t number, const Volume& volume, bool threads,
                            std::size_t* triangles) {
  return options.tolerant ? check_tolerance(volume, mesh_tolerance(volume, number), threads, triangles)
                          : check_mesh(volume, threads, triangles);
}

void run_volume(const MeshOptions& options, std::uint64_t number, MeshResults& out) {
  const MeshScene scene = mesh_scene(number);
  MeshTally& tally = out.scenes[static_cast<std::size_t>(scene)];
  ++tally.volumes;
  const bool threads = options.threads_every > 0 && number % static_cast<unsigned>(options.threads_every) == 0;
  out.thread_checks += threads;
  Problem problem;
  try {
    std::size_t triangles = 0;
    problem = check_volume_number(options, number, mesh_volume(options.seed, number), threads, &triangles);
    tally.empty += triangles == 0, tally.triangles += static_cast<long>(triangles);
  } catch (const std::exception& e) {
    problem = std::string("an exception: ") + e.what();
  }
  if (problem.empty()) return;
  ++tally.failures;
  if (out.failures.size() < kVolumesKept)
    out.failures.push_back({options.seed, number, scene, problem, options.tolerant});
}

MeshResults run_meshes(const MeshOptions& options, std::uint64_t volumes,
                       const std::function<bool(const MeshResults&)>& progress) {
  MeshResults out;
  for (std::uint64_t n = 0; n < volumes; ++n) {
    run_volume(options, n, out);
    if (progress && !progress(out)) break;
  }
  return out;
}

std::string reproducer(const MeshFailure& failure) {
  return "riffler_mesh_stress --seed " + std::to_string(failure.seed) + " --volume " + std::to_string(failure.number) +
         (failure.tolerant ? " --tolerant" : "") + " --save failure.rvol";
}

}  // namespace riffler::stress
