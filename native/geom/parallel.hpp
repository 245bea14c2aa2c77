// Fork and join over an index range.
#pragma once

#include <cstddef>
#include <functional>

#include "geom/progress.hpp"

namespace riffler {

/// Threads a parallel call uses: RIFFLER_THREADS where it is set, else the process's CPU affinity; at least 1.
int thread_count();

/// Runs body(begin, end) over disjoint chunks of [0, n) of at most `grain` indices, on thread_count() threads, the
/// caller's among them. Chunks are the same for any number of threads; a body that writes only to places owned by its
/// indices therefore gives the same bytes for any number. The first exception is rethrown after all threads stopped.
/// `progress` is called from the calling thread only; the last it is told is 1, whichever threads did the work. Within
/// a body that runs beside others, the call starts no threads.
void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                  const Progress& progress = {});

/// As long as it lives, parallel calls of this thread start no others: the caller knows that all processors are busy.
class OneThread {
 public:
  OneThread();
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;
  ~OneThread();

 private:
  bool before_;
};

}  // namespace riffler
