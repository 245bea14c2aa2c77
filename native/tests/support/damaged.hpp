// Text as an accident leaves it: what readers must survive.
#pragma once

#include <random>
#include <string>

namespace riffler::test {

/// `good` with one to four pieces erased, bytes replaced or pieces doubled, by turns from round to round.
inline std::string damaged(const std::string& good, int round, std::mt19937& random) {
  std::uniform_int_distribution<int> byte(0, 255);
  std::string text = good;
  for (int k = 1 + round % 4; k > 0; --k) {
    const std::size_t at = static_cast<std::size_t>(random()) % text.size();
    if (round % 3 == 0) text.erase(at, 1 + static_cast<std::size_t>(random()) % 12);
    if (round % 3 == 1) text[at] = static_cast<char>(byte(random));
    if (round % 3 == 2) text.insert(at, good.substr(static_cast<std::size_t>(random()) % good.size(), 9));
  }
  return text;
}

}  // namespace riffler::test
