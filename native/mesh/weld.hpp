// Gives equal points the same index.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::mesh {

/// Numbers points in the order of their first appearance. Points that compare equal share a number, so -0 and 0 do. V
/// is Vec3 or Vec3f; no coordinate may be NaN.
template <class V>
class Welder {
 public:
  /// `expected`: estimated number of distinct points; saves rehashing.
  explicit Welder(std::size_t expected = 0) { rehash(std::bit_ceil(2 * expected + 64)); }

  int add(const V& point) {
    int index;
    add(std::span(&point, 1), &index);
    return index;
  }

  /// Adds points and writes their points.size() indices.
  void add(std::span<const V> points, int* indices) {
    // Three passes over a small block overlap the two cache misses of each look-up.
    constexpr std::size_t kBlock = 48;
    std::array<std::uint64_t, kBlock> hashes;
    for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
      const std::span<const V> block = points.subspan(begin, std::min(kBlock, points.size() - begin));
      if (2 * (points_.size() + block.size()) > slots_.size()) rehash(2 * slots_.size());
      for (std::size_t i = 0; i < block.size(); ++i) {
        hashes[i] = hash(block[i]);
        __builtin_prefetch(&slots_[hashes[i] & mask_]);
      }
      for (std::size_t i = 0; i < block.size(); ++i)
        if (const Slot& slot = slots_[hashes[i] & mask_]; slot.index >= 0) __builtin_prefetch(&points_[slot.index]);
      for (std::size_t i = 0; i < block.size(); ++i) indices[begin + i] = find_or_add(block[i], hashes[i]);
    }
  }

  const std::vector<V>& points() const { return points_; }

 private:
  struct Slot {
    std::int32_t index = -1;
    std::uint32_t tag = 0;  // upper half of the hash, compared before the coordinates
  };

  static std::uint64_t hash(const V& p) {
    std::uint64_t h = 0;
    for (int k = 0; k < 3; ++k) {
      const auto x = p[k] + 0;  // -0 becomes 0
      if constexpr (sizeof x == 4)
        h ^= std::bit_cast<std::uint32_t>(x);
      else
        h ^= std::bit_cast<std::uint64_t>(x);
      // The finaliser of splitmix64 (Steele, Lea, Flood 2014, figure 17) after each coordinate.
      h += 0x9e3779b97f4a7c15;
      h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9;
      h = (h ^ (h >> 27)) * 0x94d049bb133111eb;
      h ^= h >> 31;
    }
    return h;
  }

  int find_or_add(const V& p, std::uint64_t h) {
    const auto tag = static_cast<std::uint32_t>(h >> 32);
    for (std::size_t i = h & mask_;; i = (i + 1) & mask_) {
      Slot& slot = slots_[i];
      if (slot.index < 0) {
        if (points_.size() >= 0x7fffffff) throw std::length_error("more than 2147483647 vertices");
        slot = {static_cast<std::int32_t>(points_.size()), tag};
        points_.push_back(p);
        return slot.index;
      }
      if (slot.tag == tag && points_[slot.index] == p) return slot.index;
    }
  }

  void rehash(std::size_t size) {
    slots_.assign(size, Slot{});
    mask_ = size - 1;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const std::uint64_t h = hash(points_[k]);
      std::size_t i = h & mask_;
      while (slots_[i].index >= 0) i = (i + 1) & mask_;
      slots_[i] = {static_cast<std::int32_t>(k), static_cast<std::uint32_t>(h >> 32)};
    }
  }

  std::vector<V> points_;
  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
};

}  // namespace riffler::mesh
