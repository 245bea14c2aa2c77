// The stress run of histories: random edits of random strokes, each compared with carving everything into the base.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace riffler::stress {

/// Edits of one session after its first strokes.
inline constexpr int kEditsInSession = 16;

struct HistoryOptions {
  std::uint64_t seed = 1;
  std::vector<const char*> threads{"1", "2", "4"};  ///< one history for each number of threads
};

/// A failed check, and what to draw again.
struct HistoryFailure {
  std::uint64_t seed, session;
  int edit;
  std::string text;
};

struct HistoryResults {
  long sessions = 0, edits = 0, cancelled = 0, unchanged = 0;
  long tiles_run = 0;     ///< (stroke, tile) pairs that the edits carved
  long tiles_in_all = 0;  ///< (stroke, tile) pairs of as many replays
  std::vector<HistoryFailure> failures;
};

/// Session number `session` depends on nothing but the seed and the number. It ends with its first failure.
void run_history_session(const HistoryOptions& options, std::uint64_t session, HistoryResults& out);

/// At least `edits` edits. `progress`, called after every session, may stop the run by returning false.
HistoryResults run_histories(const HistoryOptions& options, long edits,
                             const std::function<bool(const HistoryResults&)>& progress = {});

/// The command that runs the failed session alone.
std::string reproducer(const HistoryFailure& failure);

}  // namespace riffler::stress
