#include "riffler/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/environment.hpp"
#include "base/processors.hpp"

namespace riffler::base {

namespace {

constexpr int kMaxThreads = 256;
std::atomic<int> chosen_count{0};  // 0: not set

}  // namespace

void set_thread_count(std::optional<int> count) {
  if (count && (*count < 1 || *count > kMaxThreads))
    throw std::invalid_argument("threads must be 1 to " + std::to_string(kMaxThreads) + ", not " +
                                std::to_string(*count));
  chosen_count.store(count.value_or(0), std::memory_order_relaxed);
}

int thread_count() {
  if (const int chosen = chosen_count.load(std::memory_order_relaxed)) return chosen;
  if (const std::optional<std::string> text = environment("RIFFLER_THREADS")) {
    char* end = nullptr;
    const long wanted = std::strtol(text->c_str(), &end, 10);
    if (end != text->c_str() && *end == '\0' && wanted >= 1)
      return static_cast<int>(std::min(wanted, long{kMaxThreads}));
  }
  return usable_processors();
}

namespace {

/// Whether all processors are busy: this thread runs a parallel_for together with others, or a SerialScope exists.
thread_local bool busy = false;

struct Job;
/// The job whose body this thread runs; null for none.
thread_local Job* running = nullptr;

/// State shared by the threads of one parallel_for.
struct Job {
  Job(std::size_t indices, std::size_t grain_size, const std::function<void(std::size_t, std::size_t)>& f,
      const Progress& listener)
      : n(indices), grain(grain_size), body(f), progress(listener) {}

  const std::size_t n, grain;
  const std::function<void(std::size_t, std::size_t)>& body;
  const Progress& progress;
  Job* const outer = running;  // the job in whose body this one was started
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::exception_ptr error;
  double told = 0;  // last reported share; caller's thread only

  /// Takes one chunk and runs it. Returns false if none is left.
  bool step() {
    if (stop.load(std::memory_order_relaxed)) return false;
    const std::size_t begin = next.fetch_add(grain);
    if (begin >= n) return false;
    Job* const before = std::exchange(running, this);
    try {
      body(begin, std::min(n, begin + grain));
    } catch (...) {
      fail(std::current_exception());
    }
    running = before;
    return true;
  }

  double share() const { return static_cast<double>(std::min(next.load(), n)) / static_cast<double>(n); }

  void fail(std::exception_ptr e) {
    const std::lock_guard lock(mutex);
    if (!error) error = std::move(e);
    stop = true;
  }
};

}  // namespace

void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                  const Progress& progress) {
  if (n == 0) return;
  grain = std::max<std::size_t>(1, grain);
  Job job(n, grain, body, progress);
  const std::size_t chunks = (n + grain - 1) / grain;
  const std::size_t helpers = busy ? 0 : std::min<std::size_t>(static_cast<std::size_t>(thread_count()), chunks) - 1;
  const bool was_busy = std::exchange(busy, busy || helpers > 0);
  std::vector<std::thread> threads;
  threads.reserve(helpers);
  for (std::size_t i = 0; i < helpers; ++i)
    threads.emplace_back([&job] {
      busy = true;
      while (job.step()) {
      }
    });
  bool said_all = false;
  try {
    while (job.step()) {
      const double share = job.share();
      job.told = share;
      report(progress, share);
      said_all = share == 1;
    }
  } catch (...) {
    job.fail(std::current_exception());
  }
  for (std::thread& t : threads) t.join();
  busy = was_busy;
  if (job.error) std::rethrow_exception(job.error);
  if (!said_all) report(progress, 1);  // the other threads were faster: this thread may have run no chunk at all
}

void still_wanted() {
  for (const Job* job = running; job; job = job->outer) {
    if (job->stop.load(std::memory_order_relaxed)) throw Cancelled();
    // The body has not ended, so its work does not count yet: report the last share again.
    if (job->caller == std::this_thread::get_id() && job->progress) report(job->progress, job->told);
  }
}

SerialScope::SerialScope() : before_(std::exchange(busy, true)) {}

SerialScope::~SerialScope() {
  busy = before_;
}

}  // namespace riffler::base
