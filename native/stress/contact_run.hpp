// The stress run of contact: queries of tools against parts from the degenerate limits, with and without a budget;
// checks every result.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "stress/contact_scenes.hpp"

namespace riffler::stress {

/// Poses of a session with one part and one tool; each has one query, one distance and one query with a budget.
constexpr int kPosesOfSession = 64;

/// A part from a file.
struct NamedPart {
  std::string name;
  Mesh mesh;
};

struct ContactOptions {
  std::uint64_t seed = 1;
  int reference_every = 64;           ///< poses between two comparisons with the independent reference
  int poses = kPosesOfSession;        ///< of a session
  std::vector<NamedPart> parts = {};  ///< in turns, in place of the random ones of ContactScene
};

struct ContactFailure {
  std::uint64_t seed, session;
  std::string scene;  ///< or the part's name
  long pose;
  std::string problem;
};

struct ContactTally {
  long poses = 0, touching = 0, judged = 0, cut_short = 0, failures = 0;
  double missed = 0;  ///< largest missed depth of a budget, mm
  double share = 0;   ///< largest missed depth ÷ its bound
};

struct ContactResults {
  std::map<std::string, ContactTally> scenes;  ///< by the scene's or the part's name
  std::vector<ContactFailure> failures;        ///< the first few
  ContactTally total() const;
};

/// Runs session `session` and adds its results. They depend only on the seed and the number, except for what budgets
/// leave out.
void run_contact_session(const ContactOptions& options, std::uint64_t session, ContactResults& out);

/// Runs sessions from 0 on until `poses` poses are done. `progress` is called after each session and may stop the run
/// by returning false.
ContactResults run_contacts(const ContactOptions& options, long poses,
                            const std::function<bool(const ContactResults&)>& progress = {});

/// The command that repeats the failed session.
std::string reproducer(const ContactFailure& failure);

}  // namespace riffler::stress
