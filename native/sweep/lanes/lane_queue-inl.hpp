// Queues of lane items in memory, so that rays from anywhere in a tile can share the lanes of a vector.
#if defined(RIFFLER_SWEEP_LANE_QUEUE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef RIFFLER_SWEEP_LANE_QUEUE_INL_HPP
#undef RIFFLER_SWEEP_LANE_QUEUE_INL_HPP
#else
#define RIFFLER_SWEEP_LANE_QUEUE_INL_HPP
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "sweep/lane_order.hpp"
#include "sweep/lanes/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace riffler::sweep::HWY_NAMESPACE {

using namespace base::HWY_NAMESPACE;

/// A queue of single lanes of an Item. The function `each(item, f)` calls f with each of the item's fields.
template <class Item, int kMax>
class LaneQueue {
 public:
  int count() const { return count_; }
  bool full() const { return count_ + lanes() > kMax; }

  /// Adds the lanes of `mask`.
  void add(M mask, Item& item) {
    // Compress would be slower: on some processors it takes a hundred cycles.
    const unsigned added = bits(mask);
    const auto order = hn::SetTableIndices(kD, kGathered[added].data());
    double* to = at_[0] + count_;
    each(item, [&](V& x) { hn::StoreU(hn::TableLookupLanes(x, order), kD, to), to += kRoom; });
    count_ += std::popcount(added);
  }

  /// Fills lanes of `idle` with queued items, as far as there are any. Returns these lanes.
  M take(M idle, Item& item) {
    unsigned wanted = bits(idle);
    while (std::popcount(wanted) > count_) wanted &= wanted - 1;
    count_ -= std::popcount(wanted);
    const auto order = hn::SetTableIndices(kD, kSpread[wanted].data());
    const M filled = from_bits(wanted);
    const double* from = at_[0] + count_;
    each(item, [&](V& x) { x = pick(filled, hn::TableLookupLanes(hn::LoadU(kD, from), order), x), from += kRoom; });
    return filled;
  }

 private:
  static constexpr int kRoom = kMax + base::kLanes;
  static constexpr std::size_t kFields = sizeof(Item) / sizeof(V);
  double at_[kFields][kRoom];
  int count_ = 0;
};

/// One stack of items per lane; `choose(mask, a, b)` selects between two items.
template <class Item, int kMax>
class LaneStack {
 public:
  M empty() const { return from_bits(~filled_[0] & ((1U << lanes()) - 1)); }

  void push(M mask, const Item& item) {
    unsigned rest = bits(mask);
    for (int k = 0; rest; ++k)
      if (const unsigned here = rest & ~filled_[k]) {
        at_[k] = choose(from_bits(here), item, at_[k]);
        filled_[k] |= here, rest &= ~here, top_ = std::max(top_, k);
      }
  }

  void pop(M mask, Item& item) {
    unsigned rest = bits(mask);
    for (int k = top_; rest; --k)
      if (const unsigned here = rest & filled_[k]) {
        item = choose(from_bits(here), at_[k], item);
        filled_[k] &= ~here, rest &= ~here;
      }
    while (top_ > 0 && !filled_[top_]) --top_;
  }

 private:
  Item at_[kMax];
  unsigned filled_[kMax] = {};  // lanes that have an item at each level
  int top_ = 0;
};

}  // namespace riffler::sweep::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
