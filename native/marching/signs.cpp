#include "marching/signs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "geom/parallel.hpp"

namespace riffler::marching {

namespace {

constexpr double kMargin = 1e-3;  // ε, in pitches

/// Sets bits [first, last] of a row of words.
void set_bits(std::uint64_t* row, int first, int last) {
  const int a = first / 64, b = last / 64;
  const std::uint64_t from = ~std::uint64_t{0} << (first % 64), to = ~std::uint64_t{0} >> (63 - last % 64);
  if (a == b) {
    row[a] |= from & to;
    return;
  }
  row[a] |= from;
  for (int w = a + 1; w < b; ++w) row[w] = ~std::uint64_t{0};
  row[b] |= to;
}

/// Turns one ray's spans into bits; bit I is lattice plane I along the ray.
class RayBits {
 public:
  RayBits(const Lattice& lattice, int axis, bool keep_thin)
      : zero_(lattice.at(axis, 0)), per_pitch_(1 / lattice.pitch()), last_(lattice.rays(axis)), keep_thin_(keep_thin) {}

  void operator()(std::span<const Span> spans, std::uint64_t* row) const {
    for (const Span& s : spans) {
      const double near = (s.near - zero_) * per_pitch_, far = (s.far - zero_) * per_pitch_;
      const int first = std::max(1, above(near + kMargin)), last = std::min(last_, below(far - kMargin));
      if (first <= last) {
        set_bits(row, first, last);
      } else if (keep_thin_) {
        const int nearest = std::clamp(above((near + far) / 2 - 0.5), 1, last_);
        set_bits(row, nearest, nearest);
      }
    }
  }

 private:
  /// The least plane > x and the greatest plane < x, within the lattice; a span may stick out of the box anywhere.
  int above(double x) const { return static_cast<int>(std::floor(std::clamp(x, -1.0, last_ + 1.0))) + 1; }
  int below(double x) const { return static_cast<int>(std::ceil(std::clamp(x, -1.0, last_ + 2.0))) - 1; }

  double zero_, per_pitch_;
  int last_;
  bool keep_thin_;
};

/// Transposes a 64 × 64 bit matrix in place: bit c of row r ↔ bit r of row c (Warren, Hacker's Delight, 2nd ed., §7-3).
void transpose(std::uint64_t* rows) {
  std::uint64_t mask = 0x00000000ffffffff;
  for (int width = 32; width; width >>= 1, mask ^= mask << width)
    for (int r = 0; r < 64; r = (r + width + 1) & ~width) {
      const std::uint64_t swap = ((rows[r] >> width) ^ rows[r + width]) & mask;
      rows[r] ^= swap << width;
      rows[r + width] ^= swap;
    }
}

/// The bits of a few slabs of rays that run across the columns: in each slab one ray for every K. They are written row
/// by row and turned, so that `column(slab, plane)` is the column of lattice plane `plane` along the rays.
class Slabs {
 public:
  Slabs(std::size_t count, int planes, int words)
      : words_(words),
        row_words_((planes + 63) / 64),
        rows_(static_cast<std::size_t>(words) * 64 * row_words_),
        turned_(count * static_cast<std::size_t>(row_words_) * 64 * words) {}

  void clear() { std::fill(rows_.begin(), rows_.end(), 0); }
  std::uint64_t* row(int k) { return rows_.data() + static_cast<std::size_t>(k) * row_words_; }
  const std::uint64_t* column(std::size_t slab, int plane) const { return turned_.data() + place(slab, plane); }

  /// Turns the rows into the columns of one slab.
  void turn(std::size_t slab) {
    std::array<std::uint64_t, 64> block;
    for (int w = 0; w < words_; ++w)
      for (int r = 0; r < row_words_; ++r) {
        std::uint64_t any = 0, all = ~std::uint64_t{0};
        for (int b = 0; b < 64; ++b) {
          block[b] = rows_[static_cast<std::size_t>(64 * w + b) * row_words_ + r];
          any |= block[b], all &= block[b];
        }
        std::uint64_t* const out = turned_.data() + place(slab, 64 * r) + w;
        if (any != all) {
          transpose(block.data());
          for (int b = 0; b < 64; ++b) out[static_cast<std::size_t>(b) * words_] = block[b];
        } else {  // 64 equal rows
          for (int b = 0; b < 64; ++b) out[static_cast<std::size_t>(b) * words_] = -(any >> b & 1);
        }
      }
  }

 private:
  std::size_t place(std::size_t slab, int plane) const {
    return (slab * row_words_ * 64 + plane) * static_cast<std::size_t>(words_);
  }
  int words_, row_words_;
  std::vector<std::uint64_t> rows_, turned_;
};

/// Share of a stage that is done, from the share of one of its parts.
Progress part(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [&progress, from, to](double share) { return progress(from + share * (to - from)); };
}

constexpr std::size_t kSlabs = 8;  // slabs a chunk: neighbours share the cache lines of their tiles

void signs_along_columns(const Grid& grid, const Lattice& lattice, SignField& out, bool keep_thin,
                         const Progress& progress) {
  const RayBits bits(lattice, 2, keep_thin);
  parallel_for(
      static_cast<std::size_t>(lattice.rays(0)), kSlabs,
      [&](std::size_t begin, std::size_t end) {
        for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
          for (int j = 0; j < lattice.rays(1); ++j) bits(grid.ray(i, j), out.column(i + 1, j + 1));
      },
      progress);
}

/// y rays: for each I one slab, whose planes are the columns' J.
void signs_along_y(const Grid& grid, const Lattice& lattice, SignField& out, const Progress& progress) {
  const RayBits bits(lattice, 1, false);
  parallel_for(
      static_cast<std::size_t>(lattice.rays(0)), kSlabs,
      [&](std::size_t begin, std::size_t end) {
        Slabs slabs(1, lattice.points(1), out.words());
        for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
          slabs.clear();
          for (int k = 0; k < lattice.rays(2); ++k) bits(grid.ray(k, i), slabs.row(k + 1));
          slabs.turn(0);
          std::copy_n(slabs.column(0, 1), static_cast<std::size_t>(out.words()) * lattice.rays(1),
                      out.column(i + 1, 1));
        }
      },
      progress);
}

/// x rays, last: for each J one slab, whose planes are the columns' I; leaves the majority of the three in `z`.
void vote_along_x(const Grid& grid, const Lattice& lattice, const SignField& y, SignField& z,
                  const Progress& progress) {
  const RayBits bits(lattice, 0, false);
  parallel_for(
      static_cast<std::size_t>(lattice.rays(1)), kSlabs,
      [&](std::size_t begin, std::size_t end) {
        Slabs slabs(end - begin, lattice.points(0), z.words());
        for (std::size_t j = begin; j < end; ++j) {
          slabs.clear();
          for (int k = 0; k < lattice.rays(2); ++k) bits(grid.ray(static_cast<int>(j), k), slabs.row(k + 1));
          slabs.turn(j - begin);
        }
        // The columns of a chunk's slabs lie side by side: one run through the planes for all of them.
        for (int i = 1; i <= lattice.rays(0); ++i)
          for (std::size_t j = begin; j < end; ++j) {
            const std::uint64_t *a = slabs.column(j - begin, i), *b = y.column(i, static_cast<int>(j) + 1);
            std::uint64_t* c = z.column(i, static_cast<int>(j) + 1);
            for (int w = 0; w < z.words(); ++w) c[w] = (a[w] & b[w]) | (c[w] & (a[w] | b[w]));
          }
      },
      progress);
}

}  // namespace

SignField signs_of(const Volume& volume, const Lattice& lattice, const Progress& progress) {
  SignField signs(lattice);
  const bool three = volume.grids().size() == 3;
  signs_along_columns(volume.reference(), lattice, signs, !three, part(progress, 0, three ? 0.3 : 1));
  if (!three) return signs;
  SignField y(lattice);
  signs_along_y(*volume.grid(Axis::Y), lattice, y, part(progress, 0.3, 0.6));
  vote_along_x(*volume.grid(Axis::X), lattice, y, signs, part(progress, 0.6, 1));
  return signs;
}

}  // namespace riffler::marching
