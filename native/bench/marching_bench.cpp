// B200 → mesh: a 100 × 60 × 30 mm block after 200 moves of a ball of 6 mm diameter, as a tri-dexel and as a z volume.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "bench/scenes.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/marching/mesher.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::bench {
namespace {

using bench::centre;
using bench::kMoves;

constexpr double kRadius = 3;

/// Interval of s in which the line p + s d is in the ball's sweep from a to b; empty if they do not meet.
Interval capsule(const Vec3& p, const Vec3& d, const Vec3& a, const Vec3& b) {
  Interval out;
  const auto ball = [&](const Vec3& c) {
    const double middle = glm::dot(c - p, d);
    const Vec3 off = p + middle * d - c;
    const double rest = kRadius * kRadius - glm::dot(off, off);
    if (rest > 0) out.include(middle - std::sqrt(rest)), out.include(middle + std::sqrt(rest));
  };
  ball(a), ball(b);
  const double length = glm::length(b - a);
  const Vec3 axis = (b - a) / length;
  const Vec3 dn = d - axis * glm::dot(d, axis), o = (p - a) - axis * glm::dot(p - a, axis);
  const double qa = glm::dot(dn, dn), qb = glm::dot(dn, o), rest = qb * qb - qa * (glm::dot(o, o) - kRadius * kRadius);
  if (qa > 0 && rest > 0)
    for (const double sign : {-1.0, 1.0}) {
      const double s = (-qb + sign * std::sqrt(rest)) / qa, along = glm::dot(p + s * d - a, axis);
      if (along >= 0 && along <= length) out.include(s);
    }
  return out;
}

/// The block's span on one ray minus all moves, with normals.
void cut_ray(const Vec3& p, const Vec3& d, const dexel::Span& block, dexel::TileBuilder& out) {
  struct Cut {
    Interval s;
    int move;
  };
  std::vector<Cut> cuts;
  for (int n = 0; n < kMoves; ++n) {
    const Interval s = capsule(p, d, centre(n), centre(n + 1));
    if (!s.empty() && s.far > block.near && s.near < block.far) cuts.push_back({s, n});
  }
  std::sort(cuts.begin(), cuts.end(), [](const Cut& x, const Cut& y) { return x.s.near < y.s.near; });
  const auto inward = [&](double s, int n) {  // out of the material, into the ball
    const Vec3 q = p + s * d, a = centre(n), b = centre(n + 1);
    const double t = std::clamp(glm::dot(q - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return dexel::PackedNormal::pack(a + t * (b - a) - q);
  };
  double from = block.near;
  dexel::PackedNormal from_normal = dexel::PackedNormal::pack(-d);
  for (const Cut& c : cuts) {
    if (c.s.near > from) out.add({from, c.s.near}, {from_normal, inward(c.s.near, c.move)});
    if (c.s.far > from) from = c.s.far, from_normal = inward(from, c.move);
  }
  if (from < block.far) out.add({from, block.far}, {from_normal, dexel::PackedNormal::pack(d)});
}

Volume carved_block(double pitch, const char* directions) {
  Volume volume = Volume::block({{Vec3(0.0), bench::kBlock}, pitch, directions});
  for (dexel::Grid& grid : volume.grids())
    base::parallel_for(grid.tile_count(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        grid.fill_tile(t, [&](int i, int j, dexel::TileBuilder& builder) {
          cut_ray(to_world(grid.axis(), Vec3(grid.u(i), grid.v(j), 0)), to_world(grid.axis(), Vec3(0, 0, 1)),
                  {grid.box().lower.z, grid.box().upper.z}, builder);
        });
    });
  volume.touch();
  return volume;
}

const char* directions_of(const benchmark::State& state) {
  return state.range(1) == 3 ? "xyz" : "z";
}
double pitch_of(const benchmark::State& state) {
  return static_cast<double>(state.range(0)) / 1000;
}

void whole(benchmark::State& state) {
  const Volume volume = carved_block(pitch_of(state), directions_of(state));
  std::size_t triangles = 0;
  for (auto _ : state) triangles = marching::to_mesh(volume).triangles.size();
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["triangles/s"] =
      benchmark::Counter(static_cast<double>(triangles), benchmark::Counter::kIsIterationInvariantRate);
}

/// Times a mesh that follows a cut of one ball.
void follow(benchmark::State& state) {
  const Volume volume = carved_block(pitch_of(state), directions_of(state));
  Volume cut = volume;
  const Tool tool = cutters::ball(2 * kRadius, 30);
  const Vec3 at = Vec3(50, 15, 30 - 1.5);
  sweep::carve(cut, tool, std::array{Pose{at, {0, 0, 1}}, Pose{at + Vec3(0.5, 0, 0), {0, 0, 1}}});
  marching::Mesher mesher(volume);
  bool there = false;
  std::size_t patches = 0;
  for (auto _ : state) patches = mesher.update((there = !there) ? cut : volume).size();
  state.counters["patches"] = static_cast<double>(patches);
}

// Pitch in µm, directions.
BENCHMARK(whole)->ArgsProduct({{500, 250, 100}, {3, 1}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(follow)->ArgsProduct({{500, 250, 100}, {3, 1}})->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace
}  // namespace riffler::bench
