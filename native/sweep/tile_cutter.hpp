// Cuts one tile with one step after another.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "riffler/dexel/grid.hpp"
#include "riffler/dexel/stats.hpp"
#include "riffler/sweep/carve_options.hpp"
#include "sweep/open_tile.hpp"
#include "sweep/ray_window.hpp"
#include "sweep/steps.hpp"

namespace riffler::sweep {

/// Contribution of one tile to one move, in the grid's frame.
struct Share {
  std::uint32_t move;
  double removed = 0;
  Vec3 force{0}, torque{0};
};

struct TileResult {
  base::BlockVector<Share> shares;
  dexel::Stats stats;
};

class TileCutter {
 public:
  /// Cuts `rays`, tile number `tile` of the grid. `measured`: whether removed material counts towards Cut::removed.
  TileCutter(const dexel::Grid& grid, std::size_t tile, OpenTile& rays, bool measured, const CarveOptions& options);

  /// Cuts with step number `number` of the carver's steps.
  void cut(const Step& step, std::size_t number);
  TileResult finish();

 private:
  void set_motion(const Motion& motion);
  bool set_window(const Footprint& footprint);
  Box3 within() const;
  void open();
  void cut_one(int ray, const RayCut& cut);
  void add_share();

  const dexel::Grid& grid_;
  const CarveOptions& options_;
  std::size_t tile_;
  int first_row_, first_column_;  // of the tile, in the grid
  OpenTile& rays_;
  RayWindow window_;
  RemovedSums sums_;
  ForceLaw law_{};
  TileResult result_;
  std::uint32_t last_move_ = ~0U;
  const Step* step_ = nullptr;
  const Motion* motion_ = nullptr;
};

}  // namespace riffler::sweep
