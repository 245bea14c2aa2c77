#include "verify/verify_plan.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "base/parallel.hpp"

namespace riffler {

VerifyPlan::VerifyPlan(Verification& verification)
    : of_(verification), slabs_(verification.fresh()), open_(slabs_.size(), 0) {
  for (SlabState& slab : slabs_) slab.snapshots.clear();
}

std::vector<VerifyPlan::Share> VerifyPlan::add(const Program& given, const Progress& progress) {
  std::vector<Share> shares;
  if (given.empty()) return shares;
  const Program& program = followed_.follow(given);
  const ProgramRows::Chunk chunk = rows_.open(program, of_.tools_);
  chunk.for_moves(of_.tools_.shapes(), of_.top_, progress, [&](const Moves& moves, const Progress& work) {
    std::vector<Share> some(slabs_.size());
    std::vector<std::uint64_t> skipped(slabs_.size());
    parallel_for(
        slabs_.size(), 1,
        [&](std::size_t k, std::size_t) {
          const SlabJob& job = of_.jobs_[k];
          if (job.material.empty()) return;
          std::vector<std::uint32_t> chosen;
          moves.for_each(0, job.material, [&](std::size_t i, Moves::Touch touch) {
            if (job.probed || (touch & Moves::Cutter)) chosen.push_back(static_cast<std::uint32_t>(i));
          });
          skipped[k] = moves.size() - chosen.size();
          if (!chosen.empty()) some[k] = {k, chosen.size(), to_packet(moves, chosen)};
        },
        work);
    for (const std::uint64_t s : skipped) stats_.skipped += s;
    for (Share& share : some)
      if (share.moves > 0) open_[share.slab] = 1, shares.push_back(std::move(share));
  });
  std::ranges::stable_sort(shares, {}, &Share::slab);
  const std::vector<StandingMove> standing = standing_moves(program, chunk.first_row);
  standing_.insert(standing_.end(), standing.begin(), standing.end());
  const auto first = static_cast<std::ptrdiff_t>(chunk.start ? 0 : 1);
  tool_.insert(tool_.end(), program.tool().begin() + first, program.tool().end());
  line_.insert(line_.end(), program.line().begin() + first, program.line().end());
  rows_.close(chunk, of_.options_.rapid_feed, of_.machine());
  followed_.taken();
  return shares;
}

std::vector<std::uint8_t> VerifyPlan::context() const {
  SlabContext context{{of_.stock_.frame()},         of_.tools_.tools(), of_.tools_.reach(), of_.options_.tolerance,
                      of_.options_.gouge_tolerance, of_.top_,           of_.part_};
  for (const Volume& fixture : of_.fixtures_) context.frames.push_back(fixture.frame());
  return to_packet(context);
}

void VerifyPlan::check_slab(std::size_t slab) const {
  if (slab >= slabs_.size() || !open_[slab])
    throw std::invalid_argument("slab " + std::to_string(slab) + " has no moves, or has been finished");
}

std::vector<std::uint8_t> VerifyPlan::task(std::size_t slab) const {
  check_slab(slab);
  const SlabJob& job = of_.jobs_[slab];
  SlabTask task{job.fixture, job.slab, job.probed, slabs_[slab].report.strikes, slabs_[slab].tiles, {}};
  if (job.fixture >= 0)
    task.tiles = tiles_of(of_.fixtures_[static_cast<std::size_t>(job.fixture)].reference(), job.slab);
  else if (of_.target_)
    task.part = of_.target_->tiles(job.slab);
  return to_packet(task);
}

void VerifyPlan::accept(std::size_t k, std::span<const std::uint8_t> packet, bool last) {
  check_slab(k);
  SlabResult result = result_of(packet);
  SlabState& slab = slabs_[k];
  std::int64_t before = slab.report.removed.empty() ? 0 : slab.report.removed.back().first;
  bool good = result.tiles.size() == slab.tiles.size();
  for (const auto& [row, taken] : result.report.removed) good = good && row > before, before = row;
  const auto rows = static_cast<std::int64_t>(line_.size());
  for (const Event& e : result.report.events) good = good && 0 < e.row && e.row < rows;
  if (!good || before >= rows) throw std::invalid_argument("result: not of slab " + std::to_string(k));

  for (std::size_t t = 0; t < slab.tiles.size(); ++t)
    if (result.tiles[t]) slab.tiles[t] = std::move(result.tiles[t]);
  SlabReport& to = slab.report;
  to.removed.insert(to.removed.end(), result.report.removed.begin(), result.report.removed.end());
  to.events.insert(to.events.end(), result.report.events.begin(), result.report.events.end());
  to.strikes = result.report.strikes;
  stats_ += result.stats;
  if (!last) return;
  open_[k] = 0;
  merge_finished();
}

void VerifyPlan::merge_finished() {
  removed_.resize(line_.size());
  for (; merged_ < slabs_.size() && !open_[merged_]; ++merged_) {
    for (const auto& [row, taken] : slabs_[merged_].report.removed) removed_[static_cast<std::size_t>(row)] += taken;
    slabs_[merged_].report.removed = {};
  }
}

VerifyReport VerifyPlan::finish(const Progress& progress) {
  merge_finished();
  if (merged_ < slabs_.size()) throw std::logic_error("the result of slab " + std::to_string(merged_) + " is missing");
  FindingList findings;
  if (!line_.empty()) {
    std::vector<Event> events = of_.missing_;
    for (const SlabState& slab : slabs_)
      events.insert(events.end(), slab.report.events.begin(), slab.report.events.end());
    add_spindle(standing_, removed_, 0, of_.least_cut(), events);
    findings.add(std::move(events), tool_, line_, 0);
  }
  VerifyReport report =
      of_.conclude(slabs_, findings, rows_.tools(), rows_.without_tool(), rows_.faults(), rows_.notes(), progress);
  report.removed = std::move(removed_), report.seconds = rows_.take_seconds(), report.stats = stats_;
  return Verification::of_rows(std::move(report), followed_.map());
}

}  // namespace riffler
