// Inside or outside, one bit for every lattice point.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geom/progress.hpp"
#include "marching/lattice.hpp"

namespace riffler::marching {

/// The bits of a column (I, J) stand in `words()` consecutive words, bit K % 64 of word K / 64. The outer layer is
/// outside; hence bit 0 of every column is 0, and reading the word after a column's last one for its lowest bit is
/// harmless (one spare word follows the last column).
class SignField {
 public:
  explicit SignField(const Lattice& lattice) : columns_(lattice.points(1)), words_((lattice.points(2) + 63) / 64) {
    bits_.assign(static_cast<std::size_t>(lattice.points(0)) * columns_ * words_ + 1, 0);
  }
  int words() const { return words_; }
  const std::uint64_t* column(int i, int j) const { return bits_.data() + offset(i, j); }
  std::uint64_t* column(int i, int j) { return bits_.data() + offset(i, j); }
  bool at(int i, int j, int k) const { return column(i, j)[k / 64] >> (k % 64) & 1; }

 private:
  std::size_t offset(int i, int j) const { return (static_cast<std::size_t>(i) * columns_ + j) * words_; }
  int columns_, words_;
  std::vector<std::uint64_t> bits_;
};

/// Signs of the lattice points. A ray calls a point inside where near + εh < point < far − εh, ε = 10⁻³: planes that
/// lie on lattice planes are then classified alike by all rays, whatever the last bits of their ends. The three rays
/// through a point of a tri-dexel volume decide by majority. In a volume of one direction a span that misses every
/// lattice point takes the nearest: a floor thinner than the pitch stays closed.
SignField signs_of(const Volume& volume, const Lattice& lattice, const Progress& progress);

}  // namespace riffler::marching
