#include "marching/bricks.hpp"

#include <algorithm>
#include <bit>

namespace riffler::marching {

namespace {

SignRows filled(std::uint32_t bits) {
  SignRows rows;
  rows.fill(bits);
  return rows;
}

}  // namespace

std::optional<bool> common_sign(const SignRows& rows) {
  std::uint32_t any = 0, all = ~std::uint32_t{0};
  for (const std::uint32_t row : rows) any |= row, all &= row;
  if (any == 0) return false;
  if (~all == 0) return true;
  return std::nullopt;
}

const SignRows& Bricks::outside() {
  static const SignRows rows = filled(0);
  return rows;
}

const SignRows& Bricks::inside() {
  static const SignRows rows = filled(~std::uint32_t{0});
  return rows;
}

Bricks::Bricks(const Lattice& lattice) {
  for (int a = 0; a < 3; ++a) count_[a] = bricks_along(lattice, a);
  bricks_.resize(index(count_[0], 0, 0));
}

Vec3i Bricks::place(std::size_t n) const {
  const auto row = static_cast<int>(n / static_cast<std::size_t>(count_[2]));
  return {row / count_[1], row % count_[1], static_cast<int>(n % static_cast<std::size_t>(count_[2]))};
}

void Bricks::set_signs(std::size_t n, const SignRows& rows) {
  Brick& brick = bricks_[n];
  if (const std::optional<bool> sign = common_sign(rows)) {
    brick.own.reset();
    brick.signs = *sign ? &inside() : &outside();
    return;
  }
  if (!brick.own) brick.own = std::make_unique<SignRows>();
  *brick.own = rows;
  brick.signs = brick.own.get();
}

std::uint32_t Bricks::quad_of(const LatticeEdge& edge) const {
  const int i = edge.i & 31, j = edge.j & 31, k = edge.k & 31;
  const Vec3i brick{edge.i >> 5, edge.j >> 5, edge.k >> 5};
  const std::uint32_t here = signs(brick.x, brick.y, brick.z)[i * kBrickSide + j];
  // Crossed edges of the column before this one: those of lower axes, and those of its own axis below.
  const auto crossed = [&](int axis) {
    if (axis == 2) return here ^ (here >> 1 | static_cast<std::uint32_t>(at(edge.i, edge.j, (edge.k | 31) + 1)) << 31);
    const int di = axis == 0, dj = axis == 1;
    const SignRows& rows = signs((edge.i + di) >> 5, (edge.j + dj) >> 5, brick.z);
    return here ^ rows[((edge.i + di) & 31) * kBrickSide + ((edge.j + dj) & 31)];
  };
  int before = 0;
  for (int axis = 0; axis < edge.axis; ++axis) before += std::popcount(crossed(axis));
  before += std::popcount(crossed(edge.axis) & ((std::uint32_t{1} << k) - 1));
  return static_cast<std::uint32_t>(active(brick.x, brick.y, brick.z)->edge(i, j)) + static_cast<std::uint32_t>(before);
}

}  // namespace riffler::marching
