// Edges by their cost, cheapest first.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace riffler::mesh {

/// A queue of buckets, eight for each factor of two: the order within 9 % of a cost is that in which edges came. That
/// is as good for the mesh as an exact order, and needs no heap. What was pushed cannot be taken back: whoever pops an
/// edge asks whether the cost is still that of the edge.
class EdgeQueue {
 public:
  struct Entry {
    int edge;
    float cost;
  };
  static constexpr int kLast = (255 << 3) - 1;  // the bucket of the largest finite cost

  /// The costs' leading bits: those of a float that is not negative are in the order of the floats.
  static int bucket_of(float cost) { return static_cast<int>(std::bit_cast<std::uint32_t>(cost) >> 20); }

  void push(int edge, float cost) {
    const int bucket = bucket_of(cost);
    if (bucket > kLast) return;
    if (bucket >= static_cast<int>(buckets_.size())) buckets_.resize(static_cast<std::size_t>(bucket) + 1);
    buckets_[bucket].entries.push_back({edge, cost});
    first_ = std::min(first_, bucket);
  }

  /// The bucket of the cheapest entry, beyond kLast if there is none.
  int first() {
    while (first_ < static_cast<int>(buckets_.size()) && buckets_[first_].empty()) buckets_[first_++].clear();
    return first_ < static_cast<int>(buckets_.size()) ? first_ : kLast + 1;
  }
  /// Takes the first entry of the bucket that `first` has just named.
  Entry pop() { return buckets_[first_].entries[buckets_[first_].taken++]; }

 private:
  struct Bucket {
    std::vector<Entry> entries;
    std::size_t taken = 0;
    bool empty() const { return taken == entries.size(); }
    void clear() { entries.clear(), taken = 0; }
  };
  std::vector<Bucket> buckets_;
  int first_ = 0;
};

}  // namespace riffler::mesh
