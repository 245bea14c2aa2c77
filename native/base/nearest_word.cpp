#include "base/nearest_word.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace riffler::base {

namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// The edits that turn one word into the other: "optimal string alignment", in three rows of its table.
std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_above(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(two_above, above), std::swap(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
      const bool exchanged = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (exchanged) row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_word_hint(std::string_view word, std::span<const std::string> known) {
  constexpr std::size_t kLongest = 100;  // a longer word is not a misspelt name, and the table grows with its length
  if (word.size() > kLongest) return "";
  const std::string* nearest = nullptr;
  std::size_t least = 0;
  for (const std::string& candidate : known) {
    const std::size_t edits = edits_between(word, candidate);
    if (3 * edits > std::max(word.size(), candidate.size())) continue;
    if (!nearest || edits < least) nearest = &candidate, least = edits;
  }
  return nearest ? "; did you mean " + *nearest + "?" : "";
}

}  // namespace riffler::base
