// Verification of programs by simulation.
//
// The stock's grids are cut in slabs, each with the moves that can touch it. What a slab holds of results depends on
// the slab and the moves alone, and the slabs' results are put together in their order: the report is the same, bit for
// bit, for any number of threads, any splitting of the program into chunks, and after any sequence of edits.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "nc/follow.hpp"
#include "nc/program.hpp"
#include "verify/edit.hpp"
#include "verify/findings.hpp"
#include "verify/machine_check.hpp"
#include "verify/program_rows.hpp"
#include "verify/report.hpp"
#include "verify/slab_job.hpp"
#include "verify/toolset.hpp"

namespace riffler {

struct VerifyOptions {
  double tolerance = 0.01;               ///< mm: as CarveOptions::tolerance; contact less deep than it is none
  double gouge_tolerance = 0.05;         ///< mm under the part's surface
  std::optional<double> rest_tolerance;  ///< mm over the part's surface; without it rest material is no fault
  double rapid_feed = 10'000;            ///< mm/min, for the time that rapids take
  /// On which it is to run; without it limits are not checked. Chunks of a program are checked one by one.
  std::optional<MachineChoice> machine = {};
};

class Verification {
 public:
  /// `part` may be null. `tools` come before a program's own. Throws std::invalid_argument naming the argument.
  Verification(Volume stock, std::shared_ptr<const Mesh> part, std::vector<Volume> fixtures, std::map<int, Tool> tools,
               const VerifyOptions& options, const Progress& progress = {});

  /// Verifies a program. Of one that is like the one before only what differs is done again. Throws
  /// std::invalid_argument naming number, row and line of a tool without a shape, or a row whose axis is exactly
  /// opposite to the one before. After that, or Cancelled, this is as it was before the call.
  VerifyReport run(const Program& program, const Progress& progress = {});

  const std::vector<SlabJob>& jobs() const { return jobs_; }
  const Volume& stock() const { return stock_; }

  /// A report on a followed program, as one on the program that it was made of.
  static VerifyReport of_rows(VerifyReport report, const RowMap& map);

 private:
  /// Of a program without via poses.
  VerifyReport run_rows(const Program& program, const Progress& progress);
  friend class VerifyPlan;
  friend class VerifyStream;
  struct Memory {  // of the run before
    RunRows rows;
    std::vector<SlabState> slabs;
  };

  std::vector<SlabState> fresh() const;
  /// Which slabs can stay as they are, and from where on the others must be run again.
  std::vector<SlabState> resume(const RunRows& rows, VerifyStats& stats) const;
  /// Runs rows (done, end) of every slab, and moves `done` on.
  void simulate(const Moves& moves, std::vector<SlabState>& slabs, bool keep, VerifyStats& stats,
                const Progress& progress) const;
  /// mm³: what is less may be rounding.
  double least_cut() const;
  const MachineChoice* machine() const { return options_.machine ? &*options_.machine : nullptr; }
  VerifyReport conclude(std::vector<SlabState>& slabs, FindingList& findings, const std::set<std::uint32_t>& tools,
                        bool without_tool, const std::vector<Finding>& faults, const std::vector<Note>& notes,
                        const Progress& progress) const;

  Volume stock_;
  std::shared_ptr<const Mesh> part_;
  std::vector<Volume> fixtures_;
  VerifyOptions options_;
  Toolset tools_;
  double top_;  ///< z above which there is nothing
  std::unique_ptr<const Target> target_;
  std::vector<SlabJob> jobs_;
  std::vector<Event> missing_;  ///< of the part in the stock
  std::optional<Memory> memory_;
};

/// A program in chunks, each of which begins with the row at which the one before ended. Keeps 16 bytes a row, and
/// nothing of the chunks.
class VerifyStream {
 public:
  /// `verification` must outlive this; its memory of runs is left alone.
  explicit VerifyStream(Verification& verification);
  /// Throws as Verification::run, and where a chunk begins elsewhere than the one before ended.
  void add(const Program& chunk, const Progress& progress = {});
  VerifyReport finish(const Progress& progress = {});

 private:
  Verification& of_;
  std::vector<SlabState> slabs_;
  FindingList findings_;
  std::vector<double> removed_;
  ProgramRows rows_;
  VerifyStats stats_;
  FollowedChunks followed_;
};

}  // namespace riffler
