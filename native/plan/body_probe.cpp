#include "plan/body_probe.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "sweep/body_groups.hpp"
#include "sweep/carve_moves.hpp"

namespace riffler::plan {

namespace {

/// Number of times a move is halved to decide what came first, cutter or shank.
constexpr int kHalvings = 12;

/// Greatest height along a direction of a box, mm.
double highest(const Vec3& low, const Vec3& high, const Vec3& along) {
  double out = 0;
  for (int i = 0; i < 3; ++i) out += std::max(along[i] * low[i], along[i] * high[i]);
  return out;
}

/// Height of the highest material along `up`, mm; a ray's material extends half a pitch around it.
double highest_material(const Volume& stock, const Vec3& up) {
  double top = -kInfinity;
  for (const dexel::Grid& grid : stock.grids()) {
    const double half = 0.5001 * grid.pitch(), wide = dexel::kTileSide * grid.pitch();
    const Vec3 along = to_local(grid.axis(), up);
    for (int u = 0; u < grid.tiles_u(); ++u)
      for (int v = 0; v < grid.tiles_v(); ++v) {
        const dexel::Tile& tile = grid.tile(grid.tile_index(u, v));
        const double x = grid.u(u * dexel::kTileSide) - half, y = grid.v(v * dexel::kTileSide) - half;
        if (tile.spans.empty() || highest({x, y, tile.reach.near}, {x + wide, y + wide, tile.reach.far}, along) <= top)
          continue;
        for (int r = 0; r < dexel::kTileSide * dexel::kTileSide; ++r) {
          const std::span<const dexel::Span> spans = tile.ray(r);
          if (spans.empty()) continue;
          const double at = x + r / dexel::kTileSide * grid.pitch(), beside = y + r % dexel::kTileSide * grid.pitch();
          top = std::max(top, highest({at, beside, spans.front().near},
                                      {at + 2 * half, beside + 2 * half, spans.back().far}, along));
        }
      }
  }
  return top;
}

double lowest_place(const std::vector<tool::Frustum>& pieces, const Pose& pose, const Vec3& up) {
  const double rise = glm::dot(pose.axis, up), lean = std::sqrt(std::max(0.0, 1 - rise * rise));
  double low = kInfinity;
  for (const tool::Frustum& f : pieces) low = std::min({low, rise * f.z0 - lean * f.r0, rise * f.z1 - lean * f.r1});
  return glm::dot(pose.tip, up) + low;
}

}  // namespace

BodyProbe::BodyProbe(const Tool& tool, const Volume& stock, const Vec3& up, double tolerance)
    : up_(up), tolerance_(0.5 * tolerance), cutter_(sweep::convex_groups(tool.cutter())) {
  const auto add = [&](const char* reason, const std::vector<tool::Frustum>& pieces) {
    if (pieces.empty()) return;
    members_.push_back({reason, sweep::body_groups(pieces, tolerance_)});
    all_.insert(all_.end(), members_.back().groups.begin(), members_.back().groups.end());
    pieces_.insert(pieces_.end(), pieces.begin(), pieces.end());
  };
  add("the shank meets the stock", tool.shank());
  add("the holder meets the stock", tool.holder());
  double high = tool.length(), wide = 0.5 * tool.diameter();
  for (const tool::Frustum& f : pieces_) high = std::max(high, f.z1), wide = std::max({wide, f.r0, f.r1});
  const dexel::Frame& frame = stock.frame();
  wide += frame.pitch;
  add("the tool would be in the stock up to above its described length",
      {{high, wide, high + glm::length(frame.box.upper - frame.box.lower), wide}});
  lower_top(stock);
}

void BodyProbe::lower_top(const Volume& stock) {
  top_ = highest_material(stock, up_);
}

bool BodyProbe::above(const Pose& from, const Pose& to) const {
  // While the axis turns by φ, a place z above the tip and r from the axis leaves the line between its ends by at most
  // (z + r) φ² / 8. What is high above the tip falls below the stock only with a large turn.
  const double chord = glm::length(to.axis - from.axis);
  double sag = 0;
  if (chord > 0) {
    const double angle = 2 * base::asin(std::min(1.0, chord / 2));
    for (const tool::Frustum& f : pieces_) sag = std::max(sag, (f.z1 + std::max(f.r0, f.r1)) * angle * angle / 8);
  }
  return std::min(lowest_place(pieces_, from, up_), lowest_place(pieces_, to, up_)) - sag >= top_;
}

bool BodyProbe::touches(const Volume& stock, std::span<const sweep::ConvexGroup> groups, std::span<const Pose> poses,
                        std::span<const std::uint32_t> ends) const {
  dexel::Stats stats;
  for (const dexel::Grid& grid : stock.grids()) {
    dexel::Grid copy = grid;
    const std::vector<double> taken = sweep::carve_moves(copy, groups, poses, ends, tolerance_, stats);
    if (std::any_of(taken.begin(), taken.end(), [](double t) { return t > 0; })) return true;
  }
  return false;
}

bool BodyProbe::touches(const Volume& stock, std::span<const Pose> poses, std::span<const std::uint32_t> ends) const {
  return touches(stock, all_, poses, ends);
}

std::vector<double> BodyProbe::cut(Volume& stock, std::span<const Pose> poses) const {
  std::vector<std::uint32_t> ends(poses.size() - 1);
  for (std::size_t k = 0; k < ends.size(); ++k) ends[k] = static_cast<std::uint32_t>(k + 1);
  dexel::Stats stats;
  std::vector<double> out;
  for (dexel::Grid& grid : stock.grids()) {
    std::vector<double> taken = sweep::carve_moves(grid, cutter_, poses, ends, tolerance_, stats);
    if (&grid == &stock.reference()) out = std::move(taken);
  }
  stock.touch();
  return out;
}

const char* BodyProbe::strike(Volume& stock, const Pose& from, const Pose& to, double& removed) const {
  return strike(stock, from, to, removed, kHalvings);
}

/// Clear of the stock before the move: nothing is struck. Touching what the cutter leaves after it: struck. In between,
/// as in a plunge with a thin shank, the halves of the move are examined one after the other.
const char* BodyProbe::strike(Volume& stock, const Pose& from, const Pose& to, double& removed, int halvings) const {
  const Pose poses[] = {from, to};
  const std::uint32_t end = 1;
  if (above(from, to) || !touches(stock, poses, {&end, 1})) {
    removed += cut(stock, poses)[0];
    return nullptr;
  }
  Volume after = stock;
  const double taken = cut(after, poses)[0];
  for (const Member& one : members_)
    if (touches(after, one.groups, poses, {&end, 1})) return one.reason;
  if (halvings == 0) {
    removed += taken, stock = std::move(after);
    return nullptr;
  }
  const Pose middle = Motion(from, to).at(0.5);
  if (const char* first = strike(stock, from, middle, removed, halvings - 1)) return first;
  return strike(stock, middle, to, removed, halvings - 1);
}

}  // namespace riffler::plan
