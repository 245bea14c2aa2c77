// The stress run of histories: compares each random edit of random strokes with carving everything into the base.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace riffler::stress {

/// Number of edits of one session after its first strokes.
inline constexpr int kEditsInSession = 16;

struct HistoryOptions {
  std::uint64_t seed = 1;
  std::vector<const char*> threads{"1", "2", "4"};  ///< one history for each number of threads
};

/// A failed check, with the numbers that reproduce it.
struct HistoryFailure {
  std::uint64_t seed, session;
  int edit;
  std::string text;
};

struct HistoryResults {
  long sessions = 0, edits = 0, cancelled = 0, unchanged = 0;
  long tiles_run = 0;     ///< (stroke, tile) pairs that the edits carved
  long tiles_in_all = 0;  ///< (stroke, tile) pairs of the same number of replays
  std::vector<HistoryFailure> failures;
};

/// Runs session number `session`, which depends only on the seed and the number. Ends at the first failure.
void run_history_session(const HistoryOptions& options, std::uint64_t session, HistoryResults& out);

/// Runs sessions for at least `edits` edits. `progress` is called after each session and may stop the run by returning
/// false.
HistoryResults run_histories(const HistoryOptions& options, long edits,
                             const std::function<bool(const HistoryResults&)>& progress = {});

/// The command that repeats the failed session.
std::string reproducer(const HistoryFailure& failure);

}  // namespace riffler::stress
