// Progress and cancellation of long calls.
#pragma once

#include <functional>

#include "riffler/base/error.hpp"

namespace riffler::base {

/// Called from time to time with the finished fraction in [0, 1], always on the thread that made the call. Returning
/// false cancels: the call throws Cancelled and leaves its object unchanged.
using Progress = std::function<bool(double)>;

/// Reports the finished fraction `share` if there is a callback. Throws Cancelled if the callback returns false.
inline void report(const Progress& progress, double share) {
  if (progress && !progress(share)) throw Cancelled();
}

/// Maps one part of a longer call to [begin, end] of the whole call's progress. Keeps a reference to `progress`.
inline Progress part(const Progress& progress, double begin, double end) {
  if (!progress) return {};
  return [&progress, begin, end](double share) { return progress(begin + share * (end - begin)); };
}

}  // namespace riffler::base

namespace riffler {
using base::Progress;
}  // namespace riffler
