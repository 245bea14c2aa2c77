// Union, difference and intersection of volumes on one grid, in place, tile by tile.
#pragma once

#include "dexel/volume.hpp"
#include "geom/progress.hpp"

namespace riffler {

enum class Boolean { Subtract, Add, Intersect };

/// a := a op b. Both must share their frame (std::invalid_argument otherwise). Tiles that the operation leaves as they
/// are keep their revision and stay shared; ends that come from b carry b's normals (turned round for Subtract).
/// Spans thinner than 1e-9 h and gaps narrower than that vanish. Cancelled leaves `a` unchanged.
void apply(Boolean op, Volume& a, const Volume& b, const Progress& progress = {});

}  // namespace riffler
