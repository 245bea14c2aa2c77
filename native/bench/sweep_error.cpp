// Measured error of carving, every cutter × kind of motion × tolerance, against the dense reference of the tests
// (signed distance to the profile, 512 times a move, every local minimum refined). Prints one Markdown table.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "sweep/carve.hpp"
#include "tests/support/dense_sweep.hpp"
#include "tool/cutters.hpp"

using namespace riffler;

namespace {

constexpr int kSamples = 512;
constexpr double kSteepest = 0.44721359549995793;  // 1/√5: below, a ray grazes and its ends count in space only

struct Case {
  std::string name;
  Pose from, to;
};

struct Errors {
  double along = 0;  ///< mm along the ray, over ends where the ray does not graze
  double space = 0;  ///< mm to the swept surface, over all ends
  long ends = 0, grazing = 0, wrong = 0;
};

Vec3 unit(double x, double y, double z) {
  return glm::normalize(Vec3(x, y, z));
}

std::vector<std::pair<std::string, Tool>> cutters_of_the_table() {
  return {
      {"ball Ø6", cutters::ball(6, 30)},
      {"flat Ø6", cutters::flat(6, 30)},
      {"fillet Ø8 r1", cutters::fillet(8, 1, 30)},
      {"taper r0.5 Ø8", cutters::taper(0.5, 0.2, 8, 40)},
      {"cone end Ø8", cutters::cone_end(1.0, 1, 0.4, 8, 40)},
      {"free profile", cutters::profile({{{1.5, 0}, {}}, {{3, 1.5}, Vec2(1.5, 1.5)}, {{2, 6}, {}}, {{4, 8}, {}}}, 30)}};
}

std::vector<Case> motions_of_the_table() {
  const Vec3 up{0, 0, 1}, tilted = unit(0.3, -0.5, 1);
  return {{"straight", {{6, 12, 6}, up}, {{24, 17, 4}, up}},
          {"plunge", {{15, 14, 16}, up}, {{15, 14, 4}, up}},
          {"tilted", {{6, 12, 6}, tilted}, {{24, 17, 4}, tilted}},
          {"rotating", {{15, 14, 4}, unit(-0.3, 0.1, 1)}, {{15, 14, 4}, unit(0.4, 0.2, 1)}},
          {"combined", {{6, 12, 6}, unit(-0.2, 0.1, 1)}, {{24, 17, 4}, unit(0.3, 0.2, 1)}}};
}

/// Distance along the ray from `s` to where the reference changes sign, looked for within `reach`; reach if nowhere.
template <class F>
double along_ray(const F& distance, double s, double reach) {
  for (double e = reach / 64; e <= reach; e *= 2) {
    const bool low = distance(s - e) > 0, high = distance(s + e) > 0;
    if (low == high) continue;
    double a = s - e, b = s + e;
    for (int k = 0; k < 40; ++k) {
      const double middle = (a + b) / 2;
      ((distance(middle) > 0) == low ? a : b) = middle;
    }
    return std::abs((a + b) / 2 - s);
  }
  return reach;
}

void compare_ray(const Grid& grid, int i, int j, const Tool& tool, const Motion& motion, double tolerance,
                 Errors& out) {
  const auto distance = [&](double s) {
    return reference::swept_distance(tool.profile(), motion, to_world(grid.axis(), {grid.u(i), grid.v(j), s}),
                                     kSamples);
  };
  const double lower = grid.box().lower.z, upper = grid.box().upper.z;
  std::vector<double> ends;
  for (const Span& s : grid.ray(i, j)) {
    if (s.near > lower) ends.push_back(s.near);
    if (s.far < upper) ends.push_back(s.far);
  }
  for (const double s : ends) {
    const double off = distance(s), d = 1e-5, slope = (distance(s + d) - distance(s - d)) / (2 * d);
    ++out.ends;
    out.space = std::max(out.space, std::abs(off));
    if (std::abs(slope) < kSteepest)
      ++out.grazing;
    else
      out.along = std::max(out.along, along_ray(distance, s, 8 * tolerance));
  }
  for (int k = 0; k < 24; ++k) {  // no interval lost or invented
    const double s = lower + (k + 0.37) / 24 * (upper - lower), off = distance(s);
    bool solid = false;
    for (const Span& span : grid.ray(i, j)) solid = solid || (s >= span.near && s <= span.far);
    out.wrong += std::abs(off) > tolerance && solid != (off > 0);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int rays = argc > 1 ? std::atoi(argv[1]) : 150;
  std::printf(
      "| cutter | motion | tolerance mm | along the ray mm | in space mm | ends (grazing) | wrong points | steps | µs "
      "|\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  bool good = true;
  for (const auto& [tool_name, tool] : cutters_of_the_table())
    for (const Case& c : motions_of_the_table())
      for (const double tolerance : {0.1, 0.01, 0.001}) {
        Volume volume = Volume::block({{{0, 0, 0}, {30, 28, 18}}, 0.25, "xyz"});
        CarveOptions options;
        options.tolerance = tolerance;
        const std::vector<Pose> poses{c.from, c.to};
        const auto start = std::chrono::steady_clock::now();
        carve(volume, tool, poses, options);
        const double us = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
        const Motion motion(c.from, c.to);
        Errors errors;
        std::mt19937_64 random(1);
        for (const Grid& grid : volume.grids())
          for (int k = 0; k < rays;) {
            const int i = static_cast<int>(random() % grid.nu()), j = static_cast<int>(random() % grid.nv());
            const auto ray = grid.ray(i, j);
            const bool untouched =
                ray.size() == 1 && ray[0].near == grid.box().lower.z && ray[0].far == grid.box().upper.z;
            if (untouched && random() % 64 != 0) continue;  // mostly rays that were cut
            compare_ray(grid, i, j, tool, motion, tolerance, errors), ++k;
          }
        const bool ok = errors.along <= tolerance && errors.space <= tolerance && errors.wrong == 0;
        good = good && ok;
        std::printf("| %s | %s | %g | %.2g | %.2g | %ld (%ld) | %ld%s | %llu | %.0f |\n", tool_name.c_str(),
                    c.name.c_str(), tolerance, errors.along, errors.space, errors.ends, errors.grazing, errors.wrong,
                    ok ? "" : " **above**", static_cast<unsigned long long>(volume.take_stats().steps), us);
        std::fflush(stdout);
      }
  std::printf("\n%s\n", good ? "Every error is within its tolerance." : "Some error is ABOVE its tolerance.");
  return good ? 0 : 1;
}
