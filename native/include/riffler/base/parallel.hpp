// Fork and join over an index range.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "riffler/base/progress.hpp"

namespace riffler::base {

/// Threads a parallel call uses: what set_thread_count said, else RIFFLER_THREADS where it is set, else the process's
/// CPU affinity; at least 1.
int thread_count();

/// Of calls that begin from now on, in any thread (where writing the environment would race with those that read it).
/// Nothing: as RIFFLER_THREADS says. Throws std::invalid_argument unless 1 ≤ count ≤ 256.
void set_thread_count(std::optional<int> count);

/// Runs body(begin, end) over disjoint chunks of [0, n) of at most `grain` indices, on thread_count() threads, the
/// caller's among them. Chunks are the same for any number of threads; a body that writes only to places owned by its
/// indices therefore gives the same bytes for any number. The first exception is rethrown after all threads stopped.
/// `progress` is called from the calling thread only; the last it is told is 1, whichever threads did the work. Within
/// a body that runs beside others, the call starts no threads.
void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                  const Progress& progress = {});

/// In a body of parallel_for that takes long, now and then: throws Cancelled where the call no longer needs what the
/// body makes, because its listener has stopped it or another body has failed. In the caller's thread the listener is
/// asked.
void still_wanted();

/// As long as it lives, parallel calls of this thread start no others: the caller knows that all processors are busy.
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
