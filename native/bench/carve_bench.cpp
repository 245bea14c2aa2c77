// Carving time of B200 and B5X, and of the yardstick in the same run. Quote the ratio, not the time. For profilers;
// `riffler bench` measures the same through Python, with errors.
#include <benchmark/benchmark.h>

#include <vector>

#include "bench/capsule_loop.hpp"
#include "bench/scenes.hpp"
#include "riffler/sweep/carve.hpp"

namespace {

using namespace riffler;

double pitch(const benchmark::State& state) {
  return static_cast<double>(state.range(0)) / 1000;
}

void per_move(benchmark::State& state) {
  state.counters["per_move"] = benchmark::Counter(static_cast<double>(state.iterations()) * bench::kMoves,
                                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void calibration(benchmark::State& state) {
  bench::CapsuleLoop loop(pitch(state));
  for (auto _ : state) {
    state.PauseTiming();
    loop.reset();
    state.ResumeTiming();
    loop.run();
    benchmark::DoNotOptimize(loop.heights().data());
  }
  per_move(state);
}

struct Job {
  bench::NamedCutter cutter;
  bool turning = false;
  double tolerance = 0.01;
  bool force = false;
  const char* directions = "z";
};

void carve_job(benchmark::State& state, const Job& job) {
  const std::vector<Pose> poses = bench::path(job.cutter.centre_height, job.turning);
  sweep::CarveOptions options;
  options.tolerance = job.tolerance;
  if (job.force) options.dt.assign(bench::kMoves, 0.001);
  const Volume block = Volume::block({{{0, 0, 0}, bench::kBlock}, pitch(state), job.directions});
  for (auto _ : state) {
    Volume volume = block;
    benchmark::DoNotOptimize(sweep::carve(volume, job.cutter.tool, poses, options));
  }
  per_move(state);
}

void add(const std::string& name, const Job& job) {
  auto* b = benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& s) { carve_job(s, job); });
  for (const int h : {500, 250, 100}) b->Arg(h);  // µm
  b->Unit(benchmark::kMillisecond);
}

void jobs() {
  auto* b = benchmark::RegisterBenchmark("calibration: capsule height map", calibration);
  for (const int h : {500, 250, 100}) b->Arg(h);
  b->Unit(benchmark::kMillisecond);
  for (const bench::NamedCutter& cutter : bench::named_cutters()) {
    add("B200 " + cutter.name, {.cutter = cutter});
    add("B200 " + cutter.name + ", force", {.cutter = cutter, .force = true});
    add("B200 " + cutter.name + ", tri-dexel", {.cutter = cutter, .directions = "xyz"});
    for (const char* tolerance : {"0.1", "0.01", "0.001"})
      add("B5X " + cutter.name + ", tolerance " + tolerance,
          {.cutter = cutter, .turning = true, .tolerance = std::stod(tolerance)});
  }
}

const int registered = (jobs(), 0);

}  // namespace
