// Carving speed on B200 and B5X, beside a calibration loop in the same run: a plain height map that takes the same
// capsules away, one thread, no dexels, no tool beyond the ball. Quote the ratio, not the time.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "sweep/carve.hpp"
#include "tool/cutters.hpp"

namespace {

using namespace riffler;

constexpr int kMoves = 200;

/// Ball centres of B200, a = 0 … 1.
Vec3 centre(int k) {
  const double a = static_cast<double>(k) / kMoves;
  return {10 + 80 * a, 30 + 15 * std::sin(12 * a), 30 - 2 * a};
}

/// B200 (`turning` = false) or B5X's path: the same centres while the axis swings ±30° about x and ±20° about y.
std::vector<Pose> path(double tip, bool turning) {
  std::vector<Pose> poses;
  for (int k = 0; k <= kMoves; ++k) {
    const double a = static_cast<double>(k) / kMoves, turn = 4 * std::acos(-1.0) * a;
    const double x = turning ? 0.5236 * std::sin(turn) : 0, y = turning ? 0.3491 * std::cos(turn) : 0;
    const Vec3 axis{std::sin(y) * std::cos(x), -std::sin(x), std::cos(y) * std::cos(x)};
    poses.push_back({centre(k) - tip * axis, glm::normalize(axis)});
  }
  return poses;
}

Frame frame(const benchmark::State& state, const char* directions) {
  return {{{0, 0, 0}, {100, 60, 30}}, static_cast<double>(state.range(0)) / 1000, directions};
}

void per_move(benchmark::State& state) {
  state.counters["per_move"] = benchmark::Counter(static_cast<double>(state.iterations()) * kMoves,
                                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void calibration(benchmark::State& state) {
  const double h = static_cast<double>(state.range(0)) / 1000, r = 3;
  const int nx = static_cast<int>(std::lround(100 / h)), ny = static_cast<int>(std::lround(60 / h));
  for (auto _ : state) {
    state.PauseTiming();
    std::vector<double> top(static_cast<std::size_t>(nx) * ny, 30.0);
    state.ResumeTiming();
    for (int k = 0; k < kMoves; ++k) {
      const Vec3 a = centre(k), v = centre(k + 1) - a;
      const double vv = glm::dot(v, v), vz = v.z;
      const int i0 = std::max(0, static_cast<int>((std::min(a.x, a.x + v.x) - r) / h));
      const int i1 = std::min(nx - 1, static_cast<int>((std::max(a.x, a.x + v.x) + r) / h));
      const int j0 = std::max(0, static_cast<int>((std::min(a.y, a.y + v.y) - r) / h));
      const int j1 = std::min(ny - 1, static_cast<int>((std::max(a.y, a.y + v.y) + r) / h));
      for (int i = i0; i <= i1; ++i)
        for (int j = j0; j <= j1; ++j) {
          const double x = (i + 0.5) * h - a.x, y = (j + 0.5) * h - a.y;
          double& z = top[static_cast<std::size_t>(i) * ny + j];
          const auto end = [&](double t) {
            const double dx = x - t * v.x, dy = y - t * v.y, d = r * r - dx * dx - dy * dy;
            return d >= 0 ? a.z + t * vz - std::sqrt(d) : 1e300;
          };
          double low = std::min(end(0), end(1));
          // Side of the capsule: w = p − a − t v with t = (p − a) · v / v², |w| = r.
          const double b = x * v.x + y * v.y, qa = 1 - vz * vz / vv, qb = -b * vz / vv,
                       qc = x * x + y * y - b * b / vv - r * r;
          const double disc = qb * qb - qa * qc;
          if (disc >= 0) {
            const double s = (-qb - std::sqrt(disc)) / qa, t = (b + s * vz) / vv;
            if (t >= 0 && t <= 1) low = std::min(low, a.z + s);
          }
          if (low < z) z = low;
        }
    }
    benchmark::DoNotOptimize(top.data());
  }
  per_move(state);
}

void carve_job(benchmark::State& state, const Tool& tool, double tip, bool turning, double tolerance, bool force,
               const char* directions) {
  const std::vector<Pose> poses = path(tip, turning);
  CarveOptions options;
  options.tolerance = tolerance;
  if (force) options.dt.assign(kMoves, 0.001);
  const Volume block = Volume::block(frame(state, directions));
  for (auto _ : state) {
    Volume volume = block;
    benchmark::DoNotOptimize(carve(volume, tool, poses, options));
  }
  per_move(state);
}

void jobs() {
  const auto pitches = [](benchmark::internal::Benchmark* b) {
    for (const int h : {500, 250, 100}) b->Arg(h);
    b->Unit(benchmark::kMillisecond);
  };
  pitches(benchmark::RegisterBenchmark("calibration: capsule height map", calibration));
  const auto add = [&](const std::string& name, const Tool& tool, double tip, bool turning, double tolerance,
                       bool force, const char* directions) {
    pitches(benchmark::RegisterBenchmark(
        name.c_str(), [=](benchmark::State& s) { carve_job(s, tool, tip, turning, tolerance, force, directions); }));
  };
  const Tool ball = cutters::ball(6, 30), flat = cutters::flat(6, 30), fillet = cutters::fillet(8, 1, 30);
  add("B200 ball", ball, 3, false, 0.01, false, "z");
  add("B200 ball, force", ball, 3, false, 0.01, true, "z");
  add("B200 ball, tri-dexel", ball, 3, false, 0.01, false, "xyz");
  add("B200 flat", flat, 0, false, 0.01, false, "z");
  add("B200 fillet", fillet, 1, false, 0.01, false, "z");
  for (const double tolerance : {0.1, 0.01, 0.001}) {
    const std::string at = ", tolerance " + std::to_string(tolerance).substr(0, 5);
    add("B5X ball" + at, ball, 3, true, tolerance, false, "z");
    add("B5X flat" + at, flat, 0, true, tolerance, false, "z");
    add("B5X fillet" + at, fillet, 1, true, tolerance, false, "z");
  }
}

const int registered = (jobs(), 0);

}  // namespace
