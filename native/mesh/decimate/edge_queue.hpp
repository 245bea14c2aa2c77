// A priority queue of edges, cheapest first.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace riffler::mesh {

/// A bucket queue with eight buckets per factor of two: edges whose costs are within 9 % of each other leave in the
/// order they came. For the mesh this is as good as an exact order, and it needs no heap. Entries cannot be removed:
/// after a pop, the caller must check that the entry's cost is still the edge's cost.
class EdgeQueue {
 public:
  struct Entry {
    int edge;
    float cost;
  };
  static constexpr int kLast = (255 << 3) - 1;  // bucket of the largest finite cost

  /// The leading bits of the cost: for non-negative floats, the order of the bits is the order of the values.
  static int bucket_of(float cost) { return static_cast<int>(std::bit_cast<std::uint32_t>(cost) >> 20); }

  void push(int edge, float cost) {
    const int bucket = bucket_of(cost);
    if (bucket > kLast) return;
    if (bucket >= static_cast<int>(buckets_.size())) buckets_.resize(static_cast<std::size_t>(bucket) + 1);
    buckets_[bucket].entries.push_back({edge, cost});
    first_ = std::min(first_, bucket);
  }

  /// Index of the first non-empty bucket; greater than kLast if the queue is empty.
  int first() {
    while (first_ < static_cast<int>(buckets_.size()) && buckets_[first_].empty()) buckets_[first_++].clear();
    return first_ < static_cast<int>(buckets_.size()) ? first_ : kLast + 1;
  }
  /// Removes the first entry of the bucket that the last call of `first` returned.
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
