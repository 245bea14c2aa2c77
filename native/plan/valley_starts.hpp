// From the net of contact points to balls that sit in valleys.
#pragma once

#include <vector>

#include "plan/valley.hpp"

namespace riffler::plan {

struct ValleyStarts {
  std::vector<Station> stations;  ///< on valleys, in the order of the net
  std::size_t pressed = 0;        ///< balls that were pressed from the net; of these:
  std::size_t stuck = 0;          ///< there was no room
  std::size_t faceting = 0;       ///< the sides are too near to one another
  std::size_t edges = 0;          ///< they rest on sharp or open edges
  std::vector<char> is_rest;      ///< for each point of the net: that it is not faceting
};

/// Presses one ball from each cube (mm) of points that look the same way: the one that enters least, if that is at most
/// `deepest` (mm). Beside every valley there are such.
ValleyStarts valley_starts(const ValleyTracer& tracer, const std::vector<Unreached>& points, double cube,
                           double deepest, const Progress& progress = {});

}  // namespace riffler::plan
