// The word that a caller probably meant by a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace riffler::base {

/// "; did you mean WORD?" with the word of `known` that differs from `word` by the fewest letters: inserted, left out,
/// replaced, or exchanged with their neighbour. At most a third of the longer word's letters may differ; upper and
/// lower case count as the same letter. Empty if no word is so near; the first of several that are equally near.
std::string nearest_word_hint(std::string_view word, std::span<const std::string> known);

}  // namespace riffler::base
