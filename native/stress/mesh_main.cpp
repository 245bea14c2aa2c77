// Meshes random volumes from the degenerate limits and checks each mesh, and lets a mesher follow random strokes; see
// usage().
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>

#include "riffler/dexel/file/file.hpp"
#include "stress/arguments.hpp"
#include "stress/following_run.hpp"
#include "stress/mesh_run.hpp"

using namespace riffler::stress;

namespace {

struct Arguments {
  MeshOptions options;
  std::uint64_t volumes = 20000;
  double seconds = 0;
  std::optional<std::uint64_t> volume;
  std::optional<std::uint64_t> strokes;
  std::optional<std::string> save;
};

void usage() {
  std::puts(
      "riffler_mesh_stress [options]\n"
      "  --volumes N   (20000)\n"
      "  --seconds N   stops after so many, if that is earlier\n"
      "  --seed N      (1)\n"
      "  --tolerant    mesh with tolerances, and compare with the mesh without\n"
      "  --strokes N   instead of meshing volumes: follow so many strokes with a tolerance\n"
      "  --volume N    this one alone: what a failure's reproducer says\n"
      "  --save FILE   with --volume: write it as .rvol; if it fails, the least of it that does, for "
      "native/tests/marching");
}

Arguments parse(int argc, char** argv) {
  Arguments out;
  each_option(argc, argv, [&](std::string_view option, const char* value) {
    if (option == "--tolerant") {
      out.options.tolerant = true;
      return Takes::Flag;
    }
    if (option == "--volumes")
      out.volumes = whole_number(option, value);
    else if (option == "--seconds")
      out.seconds = static_cast<double>(whole_number(option, value));
    else if (option == "--seed")
      out.options.seed = whole_number(option, value);
    else if (option == "--strokes")
      out.strokes = whole_number(option, value);
    else if (option == "--volume")
      out.volume = whole_number(option, value);
    else if (option == "--save" && value)
      out.save = value;
    else
      return Takes::Unknown;
    return Takes::Value;
  });
  if (out.save && !out.volume) throw std::invalid_argument("--save needs --volume");
  return out;
}

void print(const MeshFailure& f) {
  std::printf("FAILED: volume %llu (%s): %s\n  again: %s\n", static_cast<unsigned long long>(f.number), name(f.scene),
              f.problem.c_str(), reproducer(f).c_str());
  std::fflush(stdout);
}

int run_one(const Arguments& arguments) {
  riffler::Volume volume = mesh_volume(arguments.options.seed, *arguments.volume);
  const auto problem_of = [&](const riffler::Volume& v) -> Problem {
    try {
      return check_volume_number(arguments.options, *arguments.volume, v, true);
    } catch (const std::exception& e) {
      return std::string("an exception: ") + e.what();
    }
  };
  const Problem problem = problem_of(volume);
  std::printf("%s: %s\n", name(mesh_scene(*arguments.volume)), problem.empty() ? "good" : problem.c_str());
  if (!problem.empty()) volume = minimised(volume, [&](const riffler::Volume& v) { return !problem_of(v).empty(); });
  if (arguments.save) riffler::dexel::save(volume, *arguments.save);
  if (!problem.empty()) {
    std::size_t spans = 0;
    for (const riffler::dexel::Grid& grid : volume.grids()) spans += grid.span_count();
    std::printf("%zu spans of it are enough: %s\n", spans, problem_of(volume).c_str());
  }
  return !problem.empty();
}

int run_strokes(const Arguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  long made = 0;
  const std::string problem =
      follow_strokes(arguments.options.seed, static_cast<long>(*arguments.strokes), [&](long strokes) {
        made = strokes;
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        return arguments.seconds <= 0 || seconds < arguments.seconds;
      });
  if (problem.empty())
    std::printf("%ld strokes followed, seed %llu\n", made, static_cast<unsigned long long>(arguments.options.seed));
  else
    std::printf("FAILED: %s\n", problem.c_str());
  return !problem.empty();
}

int run_all(const Arguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  auto told = start;
  std::size_t printed = 0;
  const MeshResults results = run_meshes(arguments.options, arguments.volumes, [&](const MeshResults& now) {
    for (; printed < now.failures.size(); ++printed) print(now.failures[printed]);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (Clock::now() - told > std::chrono::seconds(2)) {
      told = Clock::now();
      const MeshTally t = now.total();
      std::fprintf(stderr, "%ld of %llu volumes, %.0f/s, %ld failed\n", t.volumes,
                   static_cast<unsigned long long>(arguments.volumes), static_cast<double>(t.volumes) / seconds,
                   t.failures);
    }
    return arguments.seconds <= 0 || seconds < arguments.seconds;
  });
  std::printf("seed %llu\n%-14s %9s %7s %12s %7s\n", static_cast<unsigned long long>(arguments.options.seed), "scene",
              "volumes", "empty", "triangles", "failed");
  const auto row = [](const char* what, const MeshTally& t) {
    std::printf("%-14s %9ld %7ld %12ld %7ld\n", what, t.volumes, t.empty, t.triangles, t.failures);
  };
  for (std::size_t k = 0; k < results.scenes.size(); ++k) row(name(static_cast<MeshScene>(k)), results.scenes[k]);
  row("all", results.total());
  std::printf("%ld meshed again with 4 threads\n", results.thread_checks);
  return results.total().failures > 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc > 1 && std::strcmp(argv[1], "--help") == 0) return usage(), 0;
    const Arguments arguments = parse(argc, argv);
    if (arguments.strokes) return run_strokes(arguments);
    return arguments.volume ? run_one(arguments) : run_all(arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "riffler_mesh_stress: %s\n", e.what());
    return 2;
  }
}
