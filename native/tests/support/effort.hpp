// How much of itself a test does under a sanitizer, which takes four to ten times as long: a fault of memory or of
// arithmetic shows where code runs at all, not in how many cases it holds. All cases run in the release build.
#pragma once

namespace riffler::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// How many of `all` cases to run: all, or one of `share` under a sanitizer.
constexpr int cases(int all, int share = 4) {
  return kSanitized ? (all + share - 1) / share : all;
}

}  // namespace riffler::test
