// Fork-join parallelism over an index range.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "riffler/base/progress.hpp"

namespace riffler::base {

/// Number of threads a parallel call uses: the value given to set_thread_count, else RIFFLER_THREADS if set, else the
/// size of the process's CPU affinity mask. At least 1.
int thread_count();

/// Sets the thread count, 1 ≤ count ≤ 256, for calls that start from now on, on any thread. (Changing the environment
/// variable instead would race with threads that read it.) std::nullopt: back to RIFFLER_THREADS. Throws
/// std::invalid_argument for any other count.
void set_thread_count(std::optional<int> count);

/// Runs body(begin, end) over disjoint chunks of [0, n), each of at most `grain` indices, on thread_count() threads
/// including the caller's. The chunks do not depend on the number of threads, so a body that writes only to the slots
/// of its own indices gives the same bytes for any thread count. Rethrows the first exception after all threads have
/// stopped. Calls `progress` on the calling thread only, the last time with 1. A nested call, made inside a body that
/// runs in parallel, starts no threads.
void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                  const Progress& progress = {});

/// Call it now and then in a slow parallel_for body. Throws Cancelled if the result is no longer needed, because the
/// progress callback cancelled the call or another body threw. On the caller's thread it also calls the progress
/// callback.
void still_wanted();

/// While one exists, parallel calls made on this thread run on this thread only. For callers that already keep all
/// processors busy.
class SerialScope {
 public:
  SerialScope();
  SerialScope(const SerialScope&) = delete;
  SerialScope& operator=(const SerialScope&) = delete;
  ~SerialScope();

 private:
  bool before_;
};

}  // namespace riffler::base
