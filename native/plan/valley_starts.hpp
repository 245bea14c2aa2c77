// From the net of contact points to balls seated in valleys.
#pragma once

#include <vector>

#include "plan/valley.hpp"

namespace riffler::plan {

struct ValleyStarts {
  std::vector<Station> stations;  ///< on valleys, in net order
  std::size_t pressed = 0;        ///< balls pressed from the net; of these:
  std::size_t stuck = 0;          ///< balls without room
  std::size_t faceting = 0;       ///< balls between sides at too small an angle
  std::size_t edges = 0;          ///< balls that rest on sharp or open edges
  std::vector<char> is_rest;      ///< per point of the net: 1 unless it is faceting
};

/// Presses one ball per cube (side `cube`, mm) of points with similar normals: the ball that enters least, if at most
/// by `deepest` (mm). Every valley has such points next to it.
ValleyStarts valley_starts(const ValleyTracer& tracer, const std::vector<Unreached>& points, double cube,
                           double deepest, const Progress& progress = {});

}  // namespace riffler::plan
