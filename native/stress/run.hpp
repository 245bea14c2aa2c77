// The stress run: sessions of random moves from the degenerate limits, checked after every move.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "riffler/session/journal.hpp"
#include "stress/checks.hpp"

namespace riffler::stress {

struct Options {
  std::uint64_t seed = 1;
  std::uint64_t first_session = 0;  ///< first session; continues an interrupted run
  int compare_every = 8;            ///< mean number of moves between two comparisons with the reference; 0: none
  int compared_rays = 10;           ///< number of changed rays that a comparison checks
  bool straight = false;  ///< three directions and no move that turns: many normals with a bound in little time
  int threads_every = 8;  ///< sessions between two that are carved again in one call, with 1 and 4 threads
};

inline constexpr int kMovesInSession = 16;

/// A failed check, with the numbers that reproduce it.
struct Failure {
  std::string cutter;
  bool straight;
  std::uint64_t seed, session;
  int move;
  Kind kind;
  std::string text;  ///< the fault, and the stock, tool and poses with all digits
};

struct Tally {
  long moves = 0, compared = 0, ends = 0, points = 0, normals = 0, failures = 0;
  double worst = 0;                     ///< error / allowed error
  double worst_normal = 0, turned = 0;  ///< rad: largest error of normals with a bound (checks.hpp), and of others
  Tally& operator+=(const Tally& o);
};

struct Results {
  std::array<Tally, static_cast<std::size_t>(Kind::kCount)> kinds;
  std::array<Tally, static_cast<std::size_t>(Setting::kCount)> settings;
  long thread_checks = 0;
  std::vector<Failure> failures;  ///< the first few
  Tally total() const;
};

/// Runs session number `session` of a cutter, which depends only on the seed, the cutter and the number. Ends at the
/// first failure.
void run_session(const Options& options, const std::string& cutter, std::uint64_t session, Results& out);

/// The session's stock, tool and moves up to the first failure, with one stroke per move.
session::Journal session_journal(const Options& options, const std::string& cutter, std::uint64_t session);

/// Runs sessions for at least `moves` moves. `progress` is called after each session and may stop the run by returning
/// false.
Results run(const Options& options, const std::string& cutter, long moves,
            const std::function<bool(const Results&)>& progress = {});

/// The command that repeats the failed session.
std::string reproducer(const Failure& failure);

}  // namespace riffler::stress
