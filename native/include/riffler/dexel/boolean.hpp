// Union, difference and intersection of volumes on one grid, in place, tile by tile.
#pragma once

#include <memory>
#include <string>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

enum class Boolean { Subtract, Add, Intersect };

/// Throws std::invalid_argument that says in what the frame of `what` differs from the volume's, if it does.
void check_same_grid(const Frame& frame, const Frame& other, const std::string& what);

/// a := a op b. Both must share their frame (std::invalid_argument otherwise). Tiles that the operation leaves as they
/// are keep their revision and stay shared; ends that come from b carry b's normals (turned round for Subtract).
/// Spans thinner than 1e-9 h and gaps narrower than that vanish. Cancelled leaves `a` unchanged.
void apply(Boolean op, Volume& a, const Volume& b, const Progress& progress = {});

/// The same, of one tile of `grid` (its number `tile`) that is `a` here and `b` there; `a` itself where nothing
/// changes. `builder` is empty, and is so again afterwards.
std::shared_ptr<const Tile> apply(Boolean op, const Grid& grid, std::size_t tile, const std::shared_ptr<const Tile>& a,
                                  const std::shared_ptr<const Tile>& b, TileBuilder& builder);

}  // namespace riffler::dexel
