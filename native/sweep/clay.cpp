// What may be cut (material, or air; less what is protected) is put into a volume of its own, of the tiles that the
// tool passes only, and carved there. What was taken from that volume is then taken from the real one, or added to it.
#include "sweep/clay.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "dexel/boolean.hpp"
#include "sweep/clay_tile.hpp"
#include "sweep/tile_cutter.hpp"

namespace riffler {

namespace {

using TilePtr = std::shared_ptr<const Tile>;

/// A tile that the tool may touch.
struct Touched {
  std::size_t grid, tile;
  TilePtr before;  // what may be cut of it
  TilePtr after;   // the tile in the volume at last
};

/// Tiles under the footprints of all moves, in order.
std::vector<Touched> touched_tiles(const Volume& volume, std::span<const ConvexGroup> cutter,
                                   std::span<const Pose> poses, double tolerance) {
  std::vector<Touched> out;
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    const Grid& grid = volume.grids()[g];
    std::vector<char> touched(grid.tile_count());
    const auto mark = [&](Step&& step) {
      const TileBlock under = tiles_under(grid, step.footprint);
      for (int a = under.row; a <= under.last_row; ++a)
        for (int b = under.column; b <= under.last_column; ++b) touched[grid.tile_index(a, b)] = 1;
    };
    for (std::size_t m = 1; m < poses.size(); ++m) {
      const Motion motion(to_local(grid.axis(), poses[m - 1]), to_local(grid.axis(), poses[m]));
      for_each_step(cutter, motion, 0, grid.box(), tolerance, mark);
    }
    for (std::size_t t = 0; t < touched.size(); ++t)
      if (touched[t]) out.push_back({g, t, nullptr, nullptr});
  }
  return out;
}

class Clay {
 public:
  Clay(const Volume& volume, const CarveOptions& options)
      : volume_(volume), options_(options), block_(Volume::block(volume.frame())) {}

  /// What of a tile may be cut: its material or its air, less what is protected.
  TilePtr cuttable(const Touched& t, TileBuilder& builder) const {
    const Grid& grid = volume_.grids()[t.grid];
    TilePtr out = grid.shared_tile(t.tile);
    if (options_.mode == CarveMode::Add)
      out = apply(Boolean::Subtract, grid, t.tile, block_.grids()[t.grid].shared_tile(t.tile), out, builder);
    if (!options_.protect) return out;
    return apply(Boolean::Subtract, grid, t.tile, out, options_.protect->grids()[t.grid].shared_tile(t.tile), builder);
  }

  /// The volume's tile without or with what was cut from `t.before`, of which `rest` is left.
  TilePtr changed(const Touched& t, const TilePtr& rest, TileBuilder& builder) const {
    const Grid& grid = volume_.grids()[t.grid];
    return worked_tile(options_.mode, grid, t.tile, grid.shared_tile(t.tile), t.before, rest, builder);
  }

 private:
  const Volume& volume_;
  const CarveOptions& options_;
  Volume block_;
};

/// f(tile, builder) for every tile, on all threads.
template <class F>
void for_each_tile(std::vector<Touched>& tiles, bool with_normals, const F& f) {
  constexpr std::size_t grain = 4;
  parallel_for(tiles.size(), grain, [&](std::size_t begin, std::size_t end) {
    TileBuilder builder(with_normals);
    for (std::size_t k = begin; k < end; ++k) f(tiles[k], builder);
  });
}

}  // namespace

Cut carve_clay(Volume& volume, const Tool& tool, std::span<const Pose> poses, const CarveOptions& options,
               PlainCarve& carve) {
  if (options.protect) check_same_grid(volume.frame(), options.protect->frame(), "protect");
  const bool with_normals = volume.grids().front().has_normals();
  const Clay clay(volume, options);
  std::vector<Touched> tiles = touched_tiles(volume, convex_groups(tool.cutter()), poses, options.tolerance);
  for_each_tile(tiles, with_normals, [&](Touched& t, TileBuilder& builder) { t.before = clay.cuttable(t, builder); });

  Volume work(volume.frame());
  for (const Touched& t : tiles) work.grids()[t.grid].set_tile(t.tile, t.before);
  CarveOptions plain = options;
  plain.mode = CarveMode::Remove, plain.protect = nullptr;
  Cut cut = carve(work, tool, poses, plain);

  for_each_tile(tiles, with_normals, [&](Touched& t, TileBuilder& builder) {
    t.after = clay.changed(t, work.grids()[t.grid].shared_tile(t.tile), builder);
  });
  bool any = false;
  for (const Touched& t : tiles) {
    Grid& grid = volume.grids()[t.grid];
    if (t.after == grid.shared_tile(t.tile)) continue;
    grid.set_tile(t.tile, t.after);
    any = true;
  }
  if (any) volume.touch();
  volume.count(work.take_stats());
  return cut;
}

}  // namespace riffler
