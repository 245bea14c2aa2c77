// The stress run of contact: tools held against parts from the degenerate limits, with and without a budget, and every
// answer checked.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "stress/contact_scenes.hpp"

namespace riffler::stress {

struct ContactOptions {
  std::uint64_t seed = 1;
  int reference_every = 64;  ///< poses from one that the independent reference judges to the next
};

/// One part and one tool, and this many poses, each with one query, one distance and one query with a budget.
constexpr long kPosesOfSession = 64;

struct ContactFailure {
  std::uint64_t seed, session;
  ContactScene scene;
  long pose;
  std::string problem;
};

struct ContactTally {
  long poses = 0, touching = 0, judged = 0, cut_short = 0, failures = 0;
  double missed = 0;  ///< largest missed depth of a budget, mm
  double share = 0;   ///< largest missed depth ÷ its bound
};

struct ContactResults {
  std::array<ContactTally, static_cast<std::size_t>(ContactScene::kCount)> scenes;
  std::vector<ContactFailure> failures;  ///< the first of them
  ContactTally total() const;
};

/// Adds session `session`, which depends on nothing but the seed and the number, but for what budgets leave out.
void run_contact_session(const ContactOptions& options, std::uint64_t session, ContactResults& out);

/// Sessions from 0 on until `poses` poses are done. `progress`, called after each, may stop the run by returning false.
ContactResults run_contacts(const ContactOptions& options, long poses,
                            const std::function<bool(const ContactResults&)>& progress = {});

/// The command that runs the failed session alone.
std::string reproducer(const ContactFailure& failure);

}  // namespace riffler::stress
