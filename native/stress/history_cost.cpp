#include "stress/history_cost.hpp"

#include <ctime>
#include <stdexcept>
#include <utility>
#include <vector>

#include "riffler/dexel/file/file.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"

namespace riffler::stress {

namespace {

constexpr int kPoses = 24;
constexpr double kSide = 120, kHeight = 30;  // mm

/// Processor time (s) of the whole process for a call.
template <class Call>
double seconds(const Call& call) {
  const std::clock_t begin = std::clock();
  call();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// A random bent groove of 35 mm, 1 to 2 mm deep; the tool leans by 0.2 rad and turns a little.
sweep::HistoryStroke draw_stroke(Random& random) {
  sweep::HistoryStroke out{cutters::ball(6, 40), {}};
  Vec3 tip{random.uniform(0, kSide), random.uniform(0, kSide), kHeight - random.uniform(1, 2)};
  double heading = random.uniform(0, 6.28);
  for (int k = 0; k < kPoses; ++k) {
    heading += random.uniform(-0.2, 0.2);
    tip += 1.5 * Vec3(std::cos(heading), std::sin(heading), 0);
    out.poses.push_back({tip, glm::normalize(Vec3(0.2 * std::cos(heading), 0.2 * std::sin(heading), 1))});
  }
  return out;
}

}  // namespace

HistoryCost history_cost(std::size_t strokes, const std::string& directions, double pitch, std::size_t memory_limit) {
  Random random(7);
  const Volume base = Volume::block({{{0, 0, 0}, {kSide, kSide, kHeight}}, pitch, directions});
  std::vector<sweep::HistoryStroke> all;
  for (std::size_t k = 0; k < strokes; ++k) all.push_back(draw_stroke(random));
  HistoryCost cost;
  sweep::History history(base, memory_limit);
  std::vector<sweep::StrokeId> ids;
  cost.build = seconds([&] {
    for (const sweep::HistoryStroke& s : all) ids.push_back(history.add(s));
  });
  const auto edit = [&](std::size_t k) {
    sweep::HistoryStroke bent = all[k];
    bent.poses[kPoses / 2].tip += Vec3(0.7, -0.7, 0.1);
    const double there = seconds([&] { history.replace(ids[k], bent); });
    cost.strokes_run += static_cast<double>(history.stats().strokes_run);
    cost.tiles_run += static_cast<double>(history.stats().tiles_run);
    cost.tiles_restored += static_cast<double>(history.stats().tiles_restored);
    return (there + seconds([&] { history.replace(ids[k], all[k]); })) / 2;
  };
  constexpr std::size_t kRounds = 3, kEdits = 10;
  std::vector<std::uint8_t> expected;
  for (std::size_t round = 0; round < kRounds; ++round) {
    Volume volume = base;
    cost.replay += seconds([&] {
      for (const sweep::HistoryStroke& s : all) sweep::carve(volume, s.tool, s.poses);
    });
    cost.first += edit(0), cost.last += edit(strokes - 1);
    cost.strokes_run = cost.tiles_run = cost.tiles_restored = 0;
    for (std::size_t n = 0; n < kEdits; ++n) cost.any += edit((2 * n + 1) * strokes / (2 * kEdits)) / kEdits;
    if (dexel::to_bytes(volume) != dexel::to_bytes(history.volume()))
      throw std::runtime_error("the volume differs from a replay");
  }
  for (double* s : {&cost.replay, &cost.first, &cost.any, &cost.last}) *s /= kRounds;
  for (double* n : {&cost.strokes_run, &cost.tiles_run, &cost.tiles_restored}) *n /= kEdits;
  cost.stats = history.stats();
  return cost;
}

}  // namespace riffler::stress
