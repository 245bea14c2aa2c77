// Lists without duplicates.
#pragma once

#include <algorithm>
#include <vector>

namespace riffler::base {

/// Sorts a list and removes duplicates.
template <class T>
void sort_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace riffler::base
