// Linear programs in two and three variables.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// The points x with dot(along, x) ≥ least.
template <class Vector>
struct HalfSpace {
  Vector along;
  double least;
};

/// The lowest point along `up` in the intersection of all `spaces` and the box |x_k| ≤ reach. `active`: the half-spaces
/// whose planes meet there, −1 for a side of the box. Makes one pass over `spaces` for each of the few half-spaces that
/// matter. `slack`: what counts as rounding.
struct Lowest2 {
  Vec2 point;
  std::array<int, 2> active;
};
std::optional<Lowest2> lowest(std::span<const HalfSpace<Vec2>> spaces, const Vec2& up, double reach, double slack);

struct Lowest3 {
  Vec3 point;
  std::array<int, 3> active;
};
std::optional<Lowest3> lowest(std::span<const HalfSpace<Vec3>> spaces, const Vec3& up, double reach, double slack);

}  // namespace riffler::plan
