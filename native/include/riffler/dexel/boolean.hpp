// Union, difference and intersection of volumes on the same grid, in place and tile by tile.
#pragma once

#include <memory>
#include <string>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

enum class Boolean { Subtract, Add, Intersect };

/// Throws std::invalid_argument if `other` differs from `frame`. The message names `what` and the differing property.
void check_same_grid(const Frame& frame, const Frame& other, const std::string& what);

/// a := a op b. Throws std::invalid_argument unless both have the same frame. Tiles without a change keep their
/// revision and stay shared. Span ends that come from b carry b's normals (reversed for Subtract). Spans thinner than
/// 1e-9 h vanish, and gaps narrower than that close. Cancelled leaves `a` unchanged.
void apply(Boolean op, Volume& a, const Volume& b, const Progress& progress = {});

/// Same for one tile, number `tile` of `grid`: `a` in the first volume, `b` in the second. Returns `a` itself if
/// nothing changes. `builder` is scratch space, empty before and after the call.
std::shared_ptr<const Tile> apply(Boolean op, const Grid& grid, std::size_t tile, const std::shared_ptr<const Tile>& a,
                                  const std::shared_ptr<const Tile>& b, TileBuilder& builder);

}  // namespace riffler::dexel
