#include "sweep/tile_cutter.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sweep/kernels.hpp"

namespace riffler::sweep {

TileCutter::TileCutter(const dexel::Grid& grid, std::size_t tile, OpenTile& rays, bool measured,
                       const CarveOptions& options)
    : grid_(grid),
      options_(options),
      tile_(tile),
      first_row_(static_cast<int>(tile) / grid.tiles_v() * dexel::kTileSide),
      first_column_(static_cast<int>(tile) % grid.tiles_v() * dexel::kTileSide),
      rays_(rays),
      window_{} {
  RayWindow& w = window_;
  w.rays = rays_.first(), w.planes = &rays_.planes();
  w.opened = rays_.changed();
  for (int k = 0; k < dexel::kTileSide; ++k) w.u[k] = grid.shifted_u(first_row_ + k);
  for (int k = 0; k < dexel::kTileSide + base::kLanes; ++k) w.v[k] = grid.shifted_v(first_column_ + k);
  w.uneven = (first_row_ + dexel::kTileSide >= grid.nu() && !grid.even_u()) ||
             (first_column_ + dexel::kTileSide >= grid.nv() && !grid.even_v());
  std::fill(std::begin(w.share_u), std::end(w.share_u), 1.0),
      std::fill(std::begin(w.share_v), std::end(w.share_v), 1.0);
  if (w.uneven)
    for (int k = 0; k < dexel::kTileSide; ++k) {
      w.share_u[k] = grid.width_u(std::min(first_row_ + k, grid.nu() - 1)) / grid.pitch();
      w.share_v[k] = grid.width_v(std::min(first_column_ + k, grid.nv() - 1)) / grid.pitch();
    }
  w.thinnest = OpenTile::thinnest(grid);
  w.with_times = grid.has_normals(), w.measured = measured, w.with_force = measured && !options.dt.empty();
  w.self = this, w.sums = &sums_, w.law = &law_;
  w.cut = [](void* self, int ray, const RayCut& cut) { static_cast<TileCutter*>(self)->cut_one(ray, cut); };
  w.open = [](void* self) { static_cast<TileCutter*>(self)->open(); };
}

/// Finds the rows and columns of the tile in the footprint. Returns false if there are none.
bool TileCutter::set_window(const Footprint& footprint) {
  RayWindow& w = window_;
  const double h = grid_.pitch();
  const auto [u0, u1] = dexel::ray_indices(footprint.rows(), grid_.box().lower.x, h, grid_.nu());
  w.first_row = std::max(u0 - first_row_, 0), w.last_row = std::min(u1 - first_row_, dexel::kTileSide - 1);
  const int n = w.last_row - w.first_row + 1;
  if (n <= 0) return false;
  Footprint::Rows rows;
  footprint.rows(w.u + w.first_row, n, rows);
  // as ray_indices, within the tile
  const int columns = std::min(grid_.nv() - first_column_, dexel::kTileSide);
  const double lower = grid_.box().lower.y, before = first_column_, most = columns;
  std::int32_t first[dexel::kTileSide], end[dexel::kTileSide], any = 0;
  for (int k = 0; k < n; ++k) {
    const double near = (rows.near[k] - lower) / h - 0.5 - before, from = std::min(std::max(near, 0.0), most);
    const double far = (rows.far[k] - lower) / h - 0.5 - before, to = std::min(std::max(far, -1.0), most - 1);
    const auto a = static_cast<std::int32_t>(from), b = static_cast<std::int32_t>(to);
    first[k] = a + (a < from), end[k] = b + 1 - (b > to);
    any |= first[k] < end[k];
  }
  for (int k = 0; k < n; ++k) {
    w.first[w.first_row + k] = static_cast<std::uint8_t>(first[k]);
    w.end[w.first_row + k] = static_cast<std::uint8_t>(end[k]);
  }
  w.low = footprint.height().near, w.high = footprint.height().far;
  return any != 0;
}

/// A box around the window's rays at the heights that a step can reach, where the tile has material.
Box3 TileCutter::within() const {
  const RayWindow& w = window_;
  std::uint8_t first = dexel::kTileSide, end = 0;
  for (int k = w.first_row; k <= w.last_row; ++k) {
    if (w.first[k] >= w.end[k]) continue;
    first = std::min(first, w.first[k]), end = std::max(end, w.end[k]);
  }
  const Interval& material = grid_.tile(tile_).reach;
  return {{w.u[w.first_row], w.v[first], std::max(w.low, material.near)},
          {w.u[w.last_row], w.v[end - 1], std::min(w.high, material.far)}};
}

void TileCutter::set_motion(const Motion& motion) {
  motion_ = &motion;
  const Vec3 from = motion.from().tip, to = motion.to().tip, axis = motion.axis(0.5);
  for (int i = 0; i < 3; ++i) {
    law_.tip[i] = from[i], law_.way[i] = to[i] - from[i], law_.spin[i] = motion.rotation()[i];
    law_.axis[i] = axis[i], law_.pivot[i] = to[i];
  }
  law_.turns = motion.rotation() != Vec3(0);
  law_.speed = glm::length(to - from);
}

void TileCutter::cut(const Step& step, std::size_t number) {
  step_ = &step;
  if (motion_ != step.motion) set_motion(*step.motion);
  if (!set_window(step.footprint)) return;
  result_.stats.tiles_visited += step.move != last_move_;
  last_move_ = step.move;
  RayWindow& w = window_;
  w.step = 2 * static_cast<double>(number);
  w.tested = w.changed = w.hits = 0;
  if (const auto* part = std::get_if<TurningPart>(&step.body)) {
    w.look = QuickReject(part->group, *step.motion, part->t0, part->t1, step.footprint);
    cut_turning(TurningBody(part->group, *step.motion, part->t0, part->t1, options_.tolerance), w);
  } else if (const auto* hull = std::get_if<HullPart>(&step.body)) {
    w.look = QuickReject(*hull);
    const HullBody body(*hull, within());
    if (!body.beside) cut_hull(body, w);
  } else {
    const StraightBody& body = std::get<StraightPart>(step.body).body;
    w.look = QuickReject(body);
    cut_straight(body, w);
  }
  if (w.changed > 0 && w.measured) add_share();
  result_.stats.rays_tested += w.tested, result_.stats.rays_changed += w.changed, result_.stats.hits += w.hits;
}

void TileCutter::open() {
  rays_.open();
  window_.rays = rays_.first(), window_.opened = true;
}

/// Makes the cuts that the kernel passes on: rays with more than two spans, before or after.
void TileCutter::cut_one(int ray, const RayCut& cut) {
  const int row = ray / dexel::kTileSide, column = ray % dexel::kTileSide;
  const double u = window_.u[row], v = window_.v[column];
  const int slot = (column - window_.first[row]) % base::kLanes;
  const auto removed = [&](double low, double high) {
    if (!window_.measured) return;
    const double length = (high - low) * (window_.uneven ? window_.share_u[row] * window_.share_v[column] : 1);
    sums_.length[slot] += length;
    if (!window_.with_force) return;
    const Vec3 p{u, v, (low + high) / 2}, velocity = motion_->velocity(p, (cut.near_t + cut.far_t) / 2);
    const double speed = glm::length(velocity);
    const Vec3 direction = speed > 0 ? -velocity / speed : motion_->axis((cut.near_t + cut.far_t) / 2);
    const Vec3 moment = glm::cross(p - motion_->to().tip, direction);
    for (int i = 0; i < 3; ++i)
      sums_.direction[i][slot] += length * direction[i], sums_.moment[i][slot] += length * moment[i];
  };
  const auto origin = [&](double t) {  // as origin_at of the kernels (lanes/cut_lanes-inl.hpp)
    return window_.step + std::round(std::clamp(t, 0.0, 1.0) / Origins::kUnit) * Origins::kUnit;
  };
  // The new near end is at the far end of the cut.
  if (!rays_.subtract(ray, {cut.near, cut.far}, {origin(cut.far_t), origin(cut.near_t)}, removed)) return;
  ++window_.changed;
  window_.rays = rays_.first(), window_.opened = rays_.changed();
}

/// (3.18)–(3.24) with k per volume and second.
void TileCutter::add_share() {
  const auto total = [](const double* slots) { return std::accumulate(slots, slots + base::kLanes, 0.0); };
  if (result_.shares.empty() || result_.shares.back().move != step_->move)
    result_.shares.push_back({step_->move, 0, Vec3(0), Vec3(0)});
  Share& share = result_.shares.back();
  const double area = grid_.pitch() * grid_.pitch();
  share.removed += area * total(sums_.length);
  if (window_.with_force) {
    const double scale = options_.removal_constant * area / options_.dt[step_->move];
    for (int i = 0; i < 3; ++i) {
      share.force[i] += scale * total(sums_.direction[i]);
      share.torque[i] += scale * total(sums_.moment[i]);
    }
  }
  sums_ = {};
}

TileResult TileCutter::finish() {
  return std::move(result_);
}

}  // namespace riffler::sweep
