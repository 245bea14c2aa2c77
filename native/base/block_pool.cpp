#include "riffler/base/block_pool.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>

namespace riffler::base {

namespace {

constexpr int kSmallest = 5, kLargest = 17;                     // log2 of bytes; larger blocks come from the system
constexpr std::size_t kKept = 2U << 20, kReserved = 32U << 20;  // bytes
constexpr int kDropped = 8;                                     // blocks of other sizes at most that make room for one

/// Size classes, four per factor of two: a block is at most a fifth larger than requested.
struct SizeClass {
  std::size_t number, bytes;
};

SizeClass size_class(std::size_t bytes) {
  const std::size_t last = std::max<std::size_t>(bytes, (1U << kSmallest) + 1) - 1;
  const auto power = static_cast<std::size_t>(std::bit_width(last) - 1);
  const std::size_t quarter = (last >> (power - 2)) & 3;
  return {4 * (power - kSmallest) + quarter, (std::size_t{1} << power) + ((quarter + 1) << (power - 2))};
}

std::size_t bytes_of(std::size_t number) {
  const std::size_t power = kSmallest + number / 4, quarter = number % 4;
  return (std::size_t{1} << power) + ((quarter + 1) << (power - 2));
}

/// Free blocks of one size. An atomic exchange empties a slot, so each block has exactly one taker, and no taker reads
/// a block that another thread may own; a linked stack could not guarantee that.
class Shelf {
 public:
  static constexpr std::size_t kPlaces = 256;

  void* take() {
    if (filled_.load(std::memory_order_relaxed) <= 0) return nullptr;
    const std::size_t start = first();
    for (std::size_t k = 0; k < places_.size(); ++k) {
      std::atomic<void*>& place = places_[(start + k) % places_.size()];
      if (!place.load(std::memory_order_relaxed)) continue;
      void* block = place.exchange(nullptr, std::memory_order_acquire);
      if (!block) continue;
      filled_.fetch_sub(1, std::memory_order_relaxed);
      return block;
    }
    return nullptr;
  }

  bool put(void* block) {
    if (filled_.load(std::memory_order_relaxed) >= static_cast<int>(places_.size())) return false;
    const std::size_t start = first();
    for (std::size_t k = 0; k < places_.size(); ++k) {
      std::atomic<void*>& place = places_[(start + k) % places_.size()];
      void* none = nullptr;
      if (place.load(std::memory_order_relaxed)) continue;
      if (!place.compare_exchange_strong(none, block, std::memory_order_release, std::memory_order_relaxed)) continue;
      filled_.fetch_add(1, std::memory_order_relaxed);
      return true;
    }
    return false;
  }

  std::size_t filled() const { return static_cast<std::size_t>(std::max(0, filled_.load(std::memory_order_relaxed))); }

 private:
  /// Threads start at different slots, so that they seldom collide.
  static std::size_t first() {
    static std::atomic<std::size_t> threads{0};
    thread_local const std::size_t mine = 61 * threads++;
    return mine;
  }

  std::array<std::atomic<void*>, kPlaces> places_{};
  std::atomic<int> filled_{0};
};

struct Pool {
  std::array<Shelf, 4 * (kLargest - kSmallest)> shelves;
  std::atomic<std::size_t> kept{0};  // bytes
  std::atomic<int> reserves{0};
  std::atomic<std::size_t> dropping{0};  // the shelf that gives its blocks up next

  std::size_t most() const { return reserves.load(std::memory_order_relaxed) > 0 ? kReserved : kKept; }
};

/// Never destroyed: volumes with static storage may outlive everything else.
Pool& pool() {
  static Pool& only = *new Pool;
  return only;
}

thread_local std::uint64_t asked = 0;

bool keep(Pool& all, const SizeClass& size, void* memory) noexcept {
  if (all.kept.fetch_add(size.bytes, std::memory_order_relaxed) + size.bytes <= all.most() &&
      all.shelves[size.number].put(memory))
    return true;
  all.kept.fetch_sub(size.bytes, std::memory_order_relaxed);
  return false;
}

/// Returns a block of another size to the system; false if there is none.
bool drop_another(Pool& all, std::size_t number) noexcept {
  for (std::size_t k = 0; k < all.shelves.size(); ++k) {
    const std::size_t other = all.dropping.load(std::memory_order_relaxed) % all.shelves.size();
    void* const memory = other == number ? nullptr : all.shelves[other].take();
    if (memory) {
      all.kept.fetch_sub(bytes_of(other), std::memory_order_relaxed);
      ::operator delete(memory);
      return true;
    }
    all.dropping.fetch_add(1, std::memory_order_relaxed);
  }
  return false;
}

/// Makes room in a full pool. Sizes that are no longer requested would otherwise fill it for ever, and each step of a
/// pen would take its blocks from the system.
void make_room(Pool& all, const SizeClass& size) noexcept {
  for (int k = 0; k < kDropped; ++k)
    if (all.kept.load(std::memory_order_relaxed) + size.bytes <= all.most() || !drop_another(all, size.number)) return;
}

/// Returns blocks to the system until at most `count` blocks of that size are left.
void give_back(Pool& all, const SizeClass& size, std::size_t count) noexcept {
  Shelf& shelf = all.shelves[size.number];
  while (shelf.filled() > count) {
    void* memory = shelf.take();
    if (!memory) return;
    all.kept.fetch_sub(size.bytes, std::memory_order_relaxed);
    ::operator delete(memory);
  }
}

}  // namespace

void* allocate_block(std::size_t bytes) {
  const SizeClass size = size_class(bytes);
  Pool& all = pool();
  if (size.number >= all.shelves.size()) return ++asked, ::operator new(bytes);
  if (void* block = all.shelves[size.number].take()) {
    all.kept.fetch_sub(size.bytes, std::memory_order_relaxed);
    return block;
  }
  return ++asked, ::operator new(size.bytes);
}

void free_block(void* memory, std::size_t bytes) noexcept {
  const SizeClass size = size_class(bytes);
  Pool& all = pool();
  if (size.number >= all.shelves.size()) return ::operator delete(memory);
  make_room(all, size);
  if (!keep(all, size, memory)) ::operator delete(memory);
}

BlockReserve::BlockReserve() noexcept {
  ++pool().reserves;
}

BlockReserve::~BlockReserve() {
  Pool& all = pool();
  if (--all.reserves == 0)
    for (SizeClass size = size_class(0); size.number < all.shelves.size(); size = size_class(size.bytes + 1))
      give_back(all, size, 0);
}

void BlockReserve::fill(std::size_t largest, std::size_t count) {
  Pool& all = pool();
  count = std::min(count, Shelf::kPlaces);
  const std::size_t last = std::min(size_class(largest).number + 1, all.shelves.size());
  // Free surplus blocks first, to make room.
  for (SizeClass size = size_class(0); size.number < all.shelves.size(); size = size_class(size.bytes + 1))
    give_back(all, size, size.number < last ? count : 0);
  for (SizeClass size = size_class(0); size.number < last; size = size_class(size.bytes + 1))
    while (all.shelves[size.number].filled() < count) {
      void* memory = ::operator new(size.bytes);
      if (keep(all, size, memory)) continue;
      ::operator delete(memory);
      return;
    }
}

std::uint64_t blocks_from_system() {
  return asked;
}

}  // namespace riffler::base
