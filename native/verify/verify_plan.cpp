#include "verify/verify_plan.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "riffler/base/parallel.hpp"

namespace riffler::verify {

VerifyPlan::VerifyPlan(VerifyArguments arguments, const Progress& progress)
    : run_(std::move(arguments), progress), open_(run_.slabs().size(), 0) {}

std::vector<VerifyPlan::Share> VerifyPlan::add(const nc::Program& program, const Progress& progress) {
  std::vector<Share> shares;
  const auto packets = [&](const RowChunk& chunk, const Progress& work) {
    const VerifyScene& scene = run_.scene();
    chunk.for_moves(1, scene.tools().shapes(), scene.top(), work, [&](const Moves& moves, const Progress& some) {
      for (Share& share : shares_of(moves, some))
        if (share.moves > 0) open_[share.slab] = 1, shares.push_back(std::move(share));
    });
  };
  run_.feed_by(packets, program, progress);
  std::ranges::stable_sort(shares, {}, &Share::slab);
  return shares;
}

/// For every slab, the moves that can touch it.
std::vector<VerifyPlan::Share> VerifyPlan::shares_of(const Moves& moves, const Progress& progress) {
  const std::vector<SlabJob>& jobs = run_.scene().jobs();
  std::vector<Share> shares(jobs.size());
  std::vector<std::uint64_t> skipped(jobs.size());
  base::parallel_for(
      jobs.size(), 1,
      [&](std::size_t k, std::size_t) {
        const SlabJob& job = jobs[k];
        if (job.material.empty()) return;
        std::vector<std::uint32_t> chosen;
        moves.for_each(0, job.material, [&](std::size_t i, Moves::Touch touch) {
          if (job.probed || (touch & Moves::Cutter)) chosen.push_back(static_cast<std::uint32_t>(i));
        });
        skipped[k] = moves.size() - chosen.size();
        if (!chosen.empty()) shares[k] = {k, chosen.size(), to_packet(moves, chosen)};
      },
      progress);
  for (const std::uint64_t s : skipped) run_.stats().skipped += s;
  return shares;
}

std::vector<std::uint8_t> VerifyPlan::context() const {
  const VerifyScene& scene = run_.scene();
  const VerifyOptions& options = scene.options();
  SlabContext context{{scene.stock().frame()}, scene.tools().tools(), scene.tools().reach(), options.tolerance,
                      options.gouge_tolerance, scene.top(),           scene.part()};
  for (const Volume& fixture : scene.fixtures()) context.frames.push_back(fixture.frame());
  return to_packet(context);
}

void VerifyPlan::check_slab(std::size_t slab) const {
  if (slab >= open_.size() || !open_[slab])
    throw std::invalid_argument("slab " + std::to_string(slab) + " has no moves, or has been finished");
}

std::vector<std::uint8_t> VerifyPlan::task(std::size_t k) const {
  check_slab(k);
  const SlabJob& job = run_.scene().jobs()[k];
  const SlabState& slab = run_.slabs()[k];
  return to_packet(
      SlabTask{job.fixture, job.slab, job.probed, slab.report.strikes, slab.tiles, run_.scene().part_in(job)});
}

void VerifyPlan::check_result(std::size_t k, const SlabResult& result) const {
  const SlabState& slab = run_.slabs()[k];
  std::int64_t before = slab.report.removed.empty() ? 0 : slab.report.removed.back().first;
  bool good = result.tiles.size() == (run_.scene().jobs()[k].fixture < 0 ? slab.tiles.size() : 0);
  for (const auto& [row, taken] : result.report.removed) good = good && row > before, before = row;
  const auto rows = static_cast<std::int64_t>(run_.size());
  for (const Event& e : result.report.events) good = good && 0 < e.row && e.row < rows;
  if (!good || before >= rows) throw std::invalid_argument("result: not of slab " + std::to_string(k));
}

void VerifyPlan::accept(std::size_t k, std::span<const std::uint8_t> packet, bool last) {
  check_slab(k);
  SlabResult result = result_of(packet);
  check_result(k, result);
  SlabState& slab = run_.slabs()[k];
  for (std::size_t t = 0; t < result.tiles.size(); ++t)
    if (result.tiles[t]) slab.tiles[t] = std::move(result.tiles[t]);
  SlabReport& to = slab.report;
  to.removed.insert(to.removed.end(), result.report.removed.begin(), result.report.removed.end());
  to.events.insert(to.events.end(), result.report.events.begin(), result.report.events.end());
  to.strikes = result.report.strikes;
  run_.stats() += result.stats;
  if (!last) return;
  open_[k] = 0;
  merge_finished();
}

void VerifyPlan::merge_finished() {
  for (; merged_ < open_.size() && !open_[merged_]; ++merged_) run_.take_removed(run_.slabs()[merged_]);
}

VerifyReport VerifyPlan::finish(const Progress& progress) {
  merge_finished();
  if (merged_ < open_.size()) throw std::logic_error("the result of slab " + std::to_string(merged_) + " is missing");
  return run_.finish(progress);
}

}  // namespace riffler::verify
