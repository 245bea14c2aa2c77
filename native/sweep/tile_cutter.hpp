// Cuts one tile with one step after another.
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "riffler/dexel/grid.hpp"
#include "riffler/dexel/stats.hpp"
#include "riffler/sweep/carve_options.hpp"
#include "sweep/steps.hpp"
#include "sweep/tile_cut.hpp"

namespace riffler::sweep {

/// Contribution of one tile to one move, in the grid's frame.
struct Share {
  std::uint32_t move;
  double removed = 0;
  Vec3 force{0}, torque{0};
};

struct TileResult {
  std::shared_ptr<dexel::Tile> tile;  ///< the new tile; null if nothing was cut
  base::BlockVector<Share> shares;
  dexel::Stats stats;
};

class TileCutter {
 public:
  /// `measured`: whether removed material counts towards Cut::removed.
  TileCutter(const dexel::Grid& grid, std::size_t tile, bool measured, const CarveOptions& options);

  void cut(const Step& step);
  TileResult finish();

 private:
  void set_motion(const Motion& motion);
  void set_shapes(const Step& step);
  bool set_window(const Footprint& footprint);
  void open();
  void cut_one(int ray, const RayCut& cut);
  void add_share();

  const dexel::Grid& grid_;
  const CarveOptions& options_;
  int first_row_, first_column_;  // of the tile, in the grid
  TileCut rays_;
  RayWindow window_;
  RemovedSums sums_;
  ForceLaw law_{};
  TileResult result_;
  std::uint32_t last_move_ = ~0U;
  const Step* step_ = nullptr;
  std::array<PieceShape, ConvexGroup::kMax> shapes_;  // of the step, if normals are stored
  std::size_t shape_count_ = 0;
  const Motion* motion_ = nullptr;
};

}  // namespace riffler::sweep
