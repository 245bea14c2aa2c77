// Allocates ranges of an array to bricks, which return and reuse them.
#pragma once

#include <cstddef>
#include <iterator>
#include <map>

namespace riffler::marching {

class Slots {
 public:
  /// The first free range of n places.
  std::size_t take(std::size_t n) {
    if (n == 0) return 0;
    for (auto f = free_.begin(); f != free_.end(); ++f) {
      if (f->second < n) continue;
      const std::size_t begin = f->first, rest = f->second - n;
      free_.erase(f);
      if (rest > 0) free_.emplace(begin + n, rest);
      return begin;
    }
    const std::size_t begin = end_;
    end_ += n;
    return begin;
  }

  void give_back(std::size_t begin, std::size_t n) {
    if (n == 0) return;
    auto f = free_.emplace(begin, n).first;
    if (const auto next = std::next(f); next != free_.end() && begin + n == next->first)
      f->second += next->second, free_.erase(next);
    if (f != free_.begin())
      if (const auto before = std::prev(f); before->first + before->second == f->first)
        before->second += f->second, free_.erase(f);
  }

  /// One past the last place ever taken.
  std::size_t end() const { return end_; }

 private:
  std::size_t end_ = 0;
  std::map<std::size_t, std::size_t> free_;  // begin → length
};

}  // namespace riffler::marching
