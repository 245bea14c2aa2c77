#include "verify/slab_run.hpp"

#include <algorithm>

#include "verify/rest.hpp"

namespace riffler::verify {

namespace {

/// Converts the report on a followed program into one on the original program.
void count_original_rows(VerifyReport& report, const nc::RowMap& map) {
  if (map.empty()) return;
  const auto original = [&](std::int64_t row) {
    return static_cast<std::int64_t>(map.original(static_cast<std::size_t>(row)));
  };
  for (Finding& f : report.findings) f.row = original(f.row), f.last_row = original(f.last_row);
  report.removed = map.sums(report.removed), report.seconds = map.sums(report.seconds);
}

void add_rest(VerifyReport& report, const VerifyScene& scene, const Progress& progress) {
  if (!scene.options().rest_tolerance) return;
  const Rest found = rest_on(*scene.target(), report.volume, *scene.options().rest_tolerance, progress);
  if (!(found.height > 0)) return;
  Finding rest{Kind::Rest, Member::Cutter, -1, 0, 0, 0, 0, 0, found.height, found.height, found.point, {}};
  rest.message = message_of(rest);
  report.findings.push_back(std::move(rest));
}

}  // namespace

SlabRun::SlabRun(VerifyArguments arguments, const Progress& progress)
    : SlabRun(std::make_shared<VerifyScene>(std::move(arguments), progress)) {}

SlabRun::SlabRun(std::shared_ptr<VerifyScene> scene) : scene_(std::move(scene)), slabs_(scene_->fresh()) {}

void SlabRun::feed(const nc::Program& given, const Progress& progress) {
  const auto here = [&](const RowChunk& chunk, const Progress& work) {
    chunk.for_moves(1, scene_->tools().shapes(), scene_->top(), work, [&](const Moves& moves, const Progress& share) {
      scene_->simulate(moves, slabs_, false, stats_, share);
      for (SlabState& slab : slabs_) take_removed(slab);
    });
  };
  feed_by(here, given, progress);
  settle();
  for (SlabState& slab : slabs_) slab.report.events.clear();
}

void SlabRun::feed_by(const Feeder& feeder, const nc::Program& given, const Progress& progress) {
  if (given.empty()) return rows_.add_notes(given.notes);
  const nc::Program& program = followed_.follow(given);
  const RowChunk chunk = rows_.open(program, scene_->tools());
  feeder(chunk, progress);
  const VerifyOptions& options = scene_->options();
  rows_.close(chunk, options.rapid_feed, options.machine ? &*options.machine : nullptr);
  followed_.taken();
}

void SlabRun::take_removed(SlabState& slab) {
  rows_.add_removed(slab.report);
  slab.report.removed = {};  // frees the memory too
}

/// Turns the events of the rows since the last call into findings.
void SlabRun::settle() {
  std::vector<Event> events;
  if (rows_.first_open() == 0 && rows_.size() > 0) events = scene_->missing();
  for (const SlabState& slab : slabs_)
    events.insert(events.end(), slab.report.events.begin(), slab.report.events.end());
  rows_.add_spindle(scene_->least_cut(), events);
  findings_.add(std::move(events), rows_.open_tools(), rows_.open_lines(), rows_.first_open());
  rows_.settle();
}

VerifyReport SlabRun::finish(const Progress& progress) {
  for (const SlabState& slab : slabs_) rows_.add_removed(slab.report);
  settle();
  VerifyReport report{{}, {}, {}, {}, scene_->stock(), scene_->part(), {}};
  for (std::size_t k = 0; k < slabs_.size(); ++k) {
    const SlabJob& job = scene_->jobs()[k];
    if (job.fixture < 0) put_tiles(report.volume.grids()[job.slab.grid], job.slab, slabs_[k].tiles);
  }
  report.volume.touch();
  report.findings = findings_.take();
  for (Finding& f : report.findings)
    if (f.kind == Kind::Unknown)
      if (const Tool* tool = scene_->tools().of_number(f.tool)) f.message = message_of_unknown(f, *tool);
  report.findings.insert(report.findings.end(), rows_.faults().begin(), rows_.faults().end());
  std::ranges::stable_sort(report.findings, {}, &Finding::row);
  add_rest(report, *scene_, progress);
  note_unchecked(report);
  add_notes(report, rows_.notes());
  report.removed = rows_.take_removed(), report.seconds = rows_.take_seconds(), report.stats = stats_;
  count_original_rows(report, followed_.map());
  return report;
}

void SlabRun::note_unchecked(VerifyReport& report) const {
  const VerifyOptions& options = scene_->options();
  std::vector<std::string>& out = report.not_checked;
  if (!scene_->part()) out.emplace_back("gouges and rest material: no part was given");
  if (scene_->part() && !options.rest_tolerance)
    out.emplace_back("rest material: mapped, but no rest_tolerance was given to judge it by");
  if (!options.machine) out.emplace_back("limits and reach: no machine was given");
  if (scene_->fixtures().empty()) out.emplace_back("fixtures: none were given");
  for (std::string& sentence : scene_->tools().not_described(rows_.tools())) out.push_back(std::move(sentence));
  if (rows_.without_tool()) out.emplace_back("rapids before a tool is called: the spindle is empty");
}

}  // namespace riffler::verify
