#include "riffler/verify/verification.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "riffler/base/parallel.hpp"
#include "verify/edit.hpp"
#include "verify/slab_run.hpp"

namespace riffler::verify {

namespace {

/// The last row that all slabs have simulated.
std::size_t done_by_all(const std::vector<SlabState>& slabs, std::size_t rows) {
  auto done = static_cast<std::int64_t>(rows);
  for (const SlabState& slab : slabs) done = std::clamp<std::int64_t>(slab.done, 0, done);
  return static_cast<std::size_t>(done);
}

}  // namespace

struct Verification::Core {
  Core(VerifyArguments arguments, const Progress& progress);
  VerifyReport run(const nc::Program& program, const Progress& progress);

  struct Memory {  // of the previous run
    RunRows rows;
    std::vector<SlabState> slabs;
  };

  /// Decides which slabs keep their results, and the row from which the others must be rerun.
  std::vector<SlabState> resume(const RunRows& rows, VerifyStats& stats) const;

  std::shared_ptr<VerifyScene> scene_;
  std::optional<Memory> memory_;
};

Verification::Core::Core(VerifyArguments arguments, const Progress& progress)
    : scene_(std::make_shared<VerifyScene>(std::move(arguments), progress)) {}

std::vector<SlabState> Verification::Core::resume(const RunRows& rows, VerifyStats& stats) const {
  if (!memory_) {
    std::vector<SlabState> slabs = scene_->fresh();
    for (SlabState& slab : slabs) slab.snapshots.push_back({0, slab.tiles});
    return slabs;
  }
  const std::vector<SlabJob>& jobs = scene_->jobs();
  const ProgramEdit edit = edit_between(memory_->rows, rows);
  std::vector<std::int64_t> first(jobs.size(), std::numeric_limits<std::int64_t>::max());
  const auto look = [&](const Moves& moves) {
    base::parallel_for(jobs.size(), 1, [&](std::size_t k, std::size_t) {
      const SlabJob& job = jobs[k];
      if (job.material.empty()) return;
      moves.for_each(0, job.material, [&](std::size_t i, Moves::Touch touch) {
        if (job.probed || (touch & Moves::Cutter)) first[k] = std::min(first[k], moves.row(i));
      });
    });
  };
  for_moves_of(memory_->rows, edit.before, scene_->tools().shapes(), scene_->top(), look);
  for_moves_of(rows, edit.now, scene_->tools().shapes(), scene_->top(), look);
  std::vector<SlabState> slabs = memory_->slabs;
  const auto last = static_cast<std::int64_t>(rows.poses.size()) - 1;
  for (std::size_t k = 0; k < slabs.size(); ++k) {
    if (first[k] == std::numeric_limits<std::int64_t>::max()) {
      slabs[k].renumber(edit.tail, edit.shift);
      slabs[k].done = last;
      ++stats.slabs_kept;
    } else {
      slabs[k].rewind(first[k]);
      stats.snapshots_used += slabs[k].done > 0;
    }
  }
  return slabs;
}

VerifyReport Verification::Core::run(const nc::Program& program, const Progress& progress) {
  SlabRun run(scene_);
  RunRows rows;
  const auto what_differs = [&](const RowChunk& chunk, const Progress& work) {
    rows = {chunk.program.poses(), chunk.tool, chunk.program.rapid()};
    run.slabs() = resume(rows, run.stats());
    const std::size_t done = done_by_all(run.slabs(), rows.poses.size());
    chunk.for_moves(done + 1, scene_->tools().shapes(), scene_->top(), work,
                    [&](const Moves& moves, const Progress& share) {
                      scene_->simulate(moves, run.slabs(), true, run.stats(), share);
                    });
  };
  if (program.empty()) run.slabs() = resume(rows, run.stats());
  run.feed_by(what_differs, program, base::part(progress, 0, scene_->options().rest_tolerance ? 0.8 : 1));
  VerifyReport report = run.finish(base::part(progress, 0.8, 1));
  memory_ = Memory{std::move(rows), std::move(run.slabs())};
  return report;
}

Verification::Verification(VerifyArguments arguments, const Progress& progress)
    : core_(std::make_unique<Core>(std::move(arguments), progress)) {}

Verification::~Verification() = default;
Verification::Verification(Verification&&) noexcept = default;
Verification& Verification::operator=(Verification&&) noexcept = default;

VerifyReport Verification::run(const nc::Program& program, const Progress& progress) {
  return core_->run(program, progress);
}

}  // namespace riffler::verify
