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
  std::uint64_t first_session = 0;  ///< a run that was cut short continues from here
  int compare_every = 8;            ///< moves, at random, from one comparison with the reference to the next; 0: never
  int compared_rays = 10;           ///< of those that a compared move changed
  int threads_every = 8;            ///< sessions until one is carved again in one go, with 1 and with 4 threads
};

inline constexpr int kMovesInSession = 16;

/// A failed check, and how to see it again.
struct Failure {
  std::string cutter;
  std::uint64_t seed, session;
  int move;
  Kind kind;
  std::string text;  ///< what is wrong, and the stock, the tool and the poses with all their digits
};

struct Tally {
  long moves = 0, compared = 0, ends = 0, points = 0, failures = 0;
  double worst = 0;  ///< error / allowed error
  Tally& operator+=(const Tally& o);
};

struct Results {
  std::array<Tally, static_cast<std::size_t>(Kind::kCount)> kinds;
  std::array<Tally, static_cast<std::size_t>(Setting::kCount)> settings;
  long thread_checks = 0;
  std::vector<Failure> failures;  ///< the first of them
  Tally total() const;
};

/// Session number `session` of a cutter depends on nothing but the seed, the cutter and the number. It ends with its
/// first failure.
void run_session(const Options& options, const std::string& cutter, std::uint64_t session, Results& out);

/// Its stock, tool and moves, up to the first failure, one stroke a move.
session::Journal session_journal(const Options& options, const std::string& cutter, std::uint64_t session);

/// At least `moves` moves. `progress`, called after every session, may stop the run by returning false.
Results run(const Options& options, const std::string& cutter, long moves,
            const std::function<bool(const Results&)>& progress = {});

/// The command that runs the failed session alone.
std::string reproducer(const Failure& failure);

}  // namespace riffler::stress
