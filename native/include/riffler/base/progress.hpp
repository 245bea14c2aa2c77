// Progress and cancel of long calls.
#pragma once

#include <functional>

#include "riffler/base/error.hpp"

namespace riffler::base {

/// Called now and then, always from the thread that made the call, with the finished share in [0, 1].
/// Returning false cancels: the call throws Cancelled and leaves its object unchanged.
using Progress = std::function<bool(double)>;

/// Reports `share`, if anybody listens, and throws Cancelled if the listener wants to stop.
inline void report(const Progress& progress, double share) {
  if (progress && !progress(share)) throw Cancelled();
}

/// Progress of one part of a longer call. Refers to `progress`.
inline Progress part(const Progress& progress, double begin, double end) {
  if (!progress) return {};
  return [&progress, begin, end](double share) { return progress(begin + share * (end - begin)); };
}

}  // namespace riffler::base

namespace riffler {
using base::Progress;
}  // namespace riffler
