#include "verify/verification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "mesh/orient.hpp"
#include "nc/limits.hpp"
#include "verify/rest.hpp"
#include "verify/timing.hpp"

namespace riffler {

namespace {

const VerifyOptions& checked(const VerifyOptions& options) {
  require_tolerance(options.tolerance);
  require_tolerance(options.gouge_tolerance, "gouge_tolerance");
  if (options.rest_tolerance) require_tolerance(*options.rest_tolerance, "rest_tolerance");
  require_between(options.rapid_feed, kMinFeed, kMaxFeed, "rapid_feed", "a positive feed", "mm/min");
  return options;
}

Box3 box_of_all(const Volume& stock, const std::vector<Volume>& fixtures) {
  Box3 box = stock.frame().box;
  for (const Volume& v : fixtures) box.add(v.frame().box);
  return box;
}

/// How far a tool of unknown end must go on to leave everything there is.
double beyond(const Box3& all) {
  return 2 * glm::length(all.size());
}

/// The part itself, or with its triangles turned.
std::shared_ptr<const Mesh> solid_of(std::shared_ptr<const Mesh> part) {
  try {
    validate(*part);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("part_mesh: ") + error.what());
  }
  Orientation found;
  std::optional<Mesh> turned = oriented(*part, found);
  return turned ? std::make_shared<const Mesh>(*std::move(turned)) : part;
}

std::unique_ptr<const Target> target_of(const Mesh& part, const Frame& frame, double tolerance,
                                        const Progress& progress) {
  try {
    return std::make_unique<Target>(part, frame, tolerance, progress);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("part_mesh: ") + error.what());
  }
}

Moves moves_of(const RunRows& rows, std::size_t begin, std::size_t end, std::span<const ToolShapes> shapes,
               double top) {
  Moves moves(std::span(rows.poses).subspan(begin - 1, end - begin + 1), 1, shapes, top);
  for (std::size_t row = begin; row < end; ++row)
    moves.add(static_cast<std::int64_t>(row), rows.tool[row], rows.rapid[row] != 0);
  moves.finish();
  return moves;
}

}  // namespace

Verification::Verification(Volume stock, std::shared_ptr<const Mesh> part, std::vector<Volume> fixtures,
                           std::map<int, Tool> tools, const VerifyOptions& options, const Progress& progress)
    : stock_(std::move(stock)),
      part_(std::move(part)),
      fixtures_(std::move(fixtures)),
      options_(checked(options)),
      tools_(std::move(tools), options.tolerance, beyond(box_of_all(stock_, fixtures_)), stock_.frame().pitch),
      top_(box_of_all(stock_, fixtures_).upper.z) {
  if (options_.rest_tolerance && !part_)
    throw std::invalid_argument("rest_tolerance: there is no part to compare with");
  if (part_) part_ = solid_of(std::move(part_));
  if (part_) target_ = target_of(*part_, stock_.frame(), options_.gouge_tolerance, progress);
  const auto add = [&](const Volume& volume, std::int32_t fixture) {
    for (const Slab& slab : slabs_of(volume)) {
      const Grid& grid = volume.grids()[slab.grid];
      const bool probed = &grid == &volume.reference();
      if (fixture >= 0 && !probed) continue;
      jobs_.push_back({fixture, slab, probed, material_box(grid, slab, tiles_of(grid, slab))});
    }
  };
  add(stock_, -1);
  for (std::size_t k = 0; k < fixtures_.size(); ++k) add(fixtures_[k], static_cast<std::int32_t>(k));
  if (!target_) return;
  const std::vector<SlabState> start = fresh();
  std::vector<std::vector<Event>> found(jobs_.size());
  parallel_for(jobs_.size(), 1, [&](std::size_t begin, std::size_t) {
    const SlabJob& job = jobs_[begin];
    if (job.fixture < 0)
      find_missing(*target_, stock_.grids()[job.slab.grid], job.slab, start[begin].tiles, found[begin]);
  });
  for (const std::vector<Event>& events : found) missing_.insert(missing_.end(), events.begin(), events.end());
  // The target's grids end at the stock's box.
  const Box3 &out = target_->bounds(), &in = stock_.frame().box;
  for (int k = 0; k < 3; ++k)
    for (const double over : {in.lower[k] - out.lower[k], out.upper[k] - in.upper[k]})
      if (over > options_.gouge_tolerance) {
        Vec3 point = (out.lower + out.upper) / 2.0;
        point[k] = over == in.lower[k] - out.lower[k] ? out.lower[k] : out.upper[k];
        missing_.push_back({Kind::Gouge, Member::Cutter, -1, 0, over, over, point});
      }
}

std::vector<SlabState> Verification::fresh() const {
  std::vector<SlabState> slabs(jobs_.size());
  for (std::size_t k = 0; k < jobs_.size(); ++k) {
    if (jobs_[k].fixture < 0) slabs[k].tiles = tiles_of(stock_.grids()[jobs_[k].slab.grid], jobs_[k].slab);
    slabs[k].snapshots.push_back({0, slabs[k].tiles});
  }
  return slabs;
}

std::vector<SlabState> Verification::resume(const RunRows& rows, VerifyStats& stats) const {
  if (!memory_) return fresh();
  const ProgramEdit edit = edit_between(memory_->rows, rows);
  std::vector<std::int64_t> first(jobs_.size(), std::numeric_limits<std::int64_t>::max());
  const auto look = [&](const Moves& moves) {
    parallel_for(jobs_.size(), 1, [&](std::size_t k, std::size_t) {
      const SlabJob& job = jobs_[k];
      if (job.material.empty()) return;
      moves.for_each(0, job.material, [&](std::size_t i, Moves::Touch touch) {
        if (job.probed || (touch & Moves::Cutter)) first[k] = std::min(first[k], moves.row(i));
      });
    });
  };
  for_moves_of(memory_->rows, edit.before, tools_.shapes(), top_, look);
  for_moves_of(rows, edit.now, tools_.shapes(), top_, look);
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

void Verification::simulate(const Moves& moves, std::vector<SlabState>& slabs, bool keep, VerifyStats& stats,
                            const Progress& progress) const {
  std::vector<VerifyStats> counts(jobs_.size());
  const std::int64_t row = moves.row(0);
  parallel_for(
      jobs_.size(), 1,
      [&](std::size_t k, std::size_t) {
        const SlabJob& job = jobs_[k];
        SlabState& slab = slabs[k];
        const auto first = static_cast<std::size_t>(std::max<std::int64_t>(0, slab.done + 1 - row));
        if (first >= moves.size()) return;
        slab.done = moves.row(moves.size() - 1);
        if (job.fixture >= 0) {
          const Grid& grid = fixtures_[static_cast<std::size_t>(job.fixture)].reference();
          simulate_fixture(grid, job.slab, job.fixture, options_.tolerance, moves, first, slab.report, counts[k]);
          return;
        }
        SlabSimulation simulation(stock_.grids()[job.slab.grid], job.slab, job.probed, options_.tolerance,
                                  target_ ? &target_->surface() : nullptr,
                                  target_ ? target_->tiles(job.slab) : SlabTiles());
        SlabSimulation::Saved saved;
        if (keep) saved = [&](std::int64_t at, const SlabTiles& tiles) { slab.save(at, tiles); };
        simulation.run(moves, first, slab.tiles, slab.report, counts[k], saved);
      },
      progress);
  for (const VerifyStats& c : counts) stats += c;
}

double Verification::least_cut() const {
  return options_.tolerance * stock_.reference().least_area();
}

VerifyReport Verification::conclude(std::vector<SlabState>& slabs, FindingList& findings,
                                    const std::set<std::uint32_t>& tools, bool without_tool,
                                    const std::vector<Finding>& faults, const std::vector<Note>& notes,
                                    const Progress& progress) const {
  VerifyReport report{{}, {}, {}, {}, stock_, part_, {}};
  for (std::size_t k = 0; k < slabs.size(); ++k)
    if (jobs_[k].fixture < 0) put_tiles(report.volume.grids()[jobs_[k].slab.grid], jobs_[k].slab, slabs[k].tiles);
  report.volume.touch();
  report.findings = findings.take();
  for (Finding& f : report.findings)
    if (f.kind == Kind::Unknown)
      if (const Tool* tool = tools_.of_number(f.tool)) f.message = message_of_unknown(f, *tool);
  report.findings.insert(report.findings.end(), faults.begin(), faults.end());
  std::ranges::stable_sort(report.findings, {}, &Finding::row);
  if (options_.rest_tolerance) {
    const Rest found = rest_on(*target_, report.volume, *options_.rest_tolerance, progress);
    if (found.height > 0) {
      Finding rest{Kind::Rest, Member::Cutter, -1, 0, 0, 0, 0, 0, found.height, found.height, found.point, {}};
      rest.message = message_of(rest);
      report.findings.push_back(std::move(rest));
    }
  }
  if (!part_) report.not_checked.emplace_back("gouges and rest material: no part was given");
  if (part_ && !options_.rest_tolerance)
    report.not_checked.emplace_back("rest material: mapped, but no rest_tolerance was given to judge it by");
  if (!options_.machine) report.not_checked.emplace_back("limits and reach: no machine was given");
  if (fixtures_.empty()) report.not_checked.emplace_back("fixtures: none were given");
  for (std::string& sentence : tools_.not_described(tools)) report.not_checked.push_back(std::move(sentence));
  if (without_tool) report.not_checked.emplace_back("rapids before a tool is called: nothing is in the spindle yet");
  add_notes(report, notes);
  return report;
}

VerifyReport Verification::of_rows(VerifyReport report, const RowMap& map) {
  if (map.empty()) return report;
  const auto original = [&](std::int64_t row) {
    return static_cast<std::int64_t>(map.original(static_cast<std::size_t>(row)));
  };
  for (Finding& f : report.findings) f.row = original(f.row), f.last_row = original(f.last_row);
  report.removed = map.sums(report.removed), report.seconds = map.sums(report.seconds);
  return report;
}

VerifyReport Verification::run(const Program& program, const Progress& progress) {
  if (program.via().empty()) return run_rows(program, progress);
  RowMap map;
  const Program whole = followed(program, &map);
  return of_rows(run_rows(whole, progress), map);
}

VerifyReport Verification::run_rows(const Program& program, const Progress& progress) {
  check_path(program.poses());
  const std::size_t n = program.size();
  RunRows rows{program.poses(), tools_.places(program, 0), program.rapid()};
  VerifyStats stats;
  std::vector<SlabState> slabs = resume(rows, stats);
  auto done = static_cast<std::int64_t>(n);
  for (const SlabState& slab : slabs) done = std::clamp<std::int64_t>(slab.done, 0, done);
  const Progress work = part(progress, 0, options_.rest_tolerance ? 0.8 : 1);
  for (std::size_t begin = static_cast<std::size_t>(done) + 1; begin < n; begin += kMovesAtOnce) {
    const std::size_t end = std::min(n, begin + kMovesAtOnce);
    const Moves moves = moves_of(rows, begin, end, tools_.shapes(), top_);
    const auto share = [&](std::size_t row) { return static_cast<double>(row) / static_cast<double>(n); };
    simulate(moves, slabs, true, stats, part(work, share(begin), share(end)));
  }

  std::vector<double> removed(n), seconds(n);
  std::vector<Event> events = missing_;
  if (n == 0) events.clear();
  for (const SlabState& slab : slabs) {
    for (const auto& [row, taken] : slab.report.removed) removed[static_cast<std::size_t>(row)] += taken;
    events.insert(events.end(), slab.report.events.begin(), slab.report.events.end());
  }
  add_spindle(standing_moves(program, 0), removed, 0, least_cut(), events);
  std::set<std::uint32_t> tools;
  bool without_tool = false;
  for (std::size_t row = 1; row < n; ++row) {
    seconds[row] = seconds_of(program.poses()[row - 1], program, row, options_.rapid_feed);
    if (!program.moves_in_part(row)) continue;
    if (rows.tool[row] == kNoTool)
      without_tool = true;
    else
      tools.insert(rows.tool[row]);
  }
  std::vector<Finding> faults;
  if (machine())
    if (auto fault = machine_fault(program, 0, *machine())) faults.push_back(std::move(*fault));
  FindingList findings;
  findings.add(std::move(events), program.tool(), program.line(), 0);
  VerifyReport report = conclude(slabs, findings, tools, without_tool, faults, program.notes, part(progress, 0.8, 1));
  report.removed = std::move(removed), report.seconds = std::move(seconds), report.stats = stats;
  memory_ = Memory{std::move(rows), std::move(slabs)};
  return report;
}

VerifyStream::VerifyStream(Verification& verification) : of_(verification), slabs_(verification.fresh()) {}

void VerifyStream::add(const Program& given, const Progress& progress) {
  if (given.empty()) return;
  const Program& program = followed_.follow(given);
  const ProgramRows::Chunk chunk = rows_.open(program, of_.tools_);
  std::vector<double> removed(program.size());
  chunk.for_moves(of_.tools_.shapes(), of_.top_, progress, [&](const Moves& moves, const Progress& work) {
    of_.simulate(moves, slabs_, false, stats_, work);
    for (SlabState& slab : slabs_) {
      for (const auto& [row, taken] : slab.report.removed)
        removed[static_cast<std::size_t>(row - chunk.first_row)] += taken;
      slab.report.removed.clear();
    }
  });
  std::vector<Event> events;
  if (chunk.start) events = of_.missing_;
  for (SlabState& slab : slabs_) {
    events.insert(events.end(), slab.report.events.begin(), slab.report.events.end());
    slab.report.events.clear();
  }
  add_spindle(standing_moves(program, chunk.first_row), removed, chunk.first_row, of_.least_cut(), events);
  findings_.add(std::move(events), program.tool(), program.line(), chunk.first_row);
  removed_.insert(removed_.end(), removed.begin() + (chunk.start ? 0 : 1), removed.end());
  rows_.close(chunk, of_.options_.rapid_feed, of_.machine());
  followed_.taken();
}

VerifyReport VerifyStream::finish(const Progress& progress) {
  VerifyReport report =
      of_.conclude(slabs_, findings_, rows_.tools(), rows_.without_tool(), rows_.faults(), rows_.notes(), progress);
  report.removed = std::move(removed_), report.seconds = rows_.take_seconds(), report.stats = stats_;
  return Verification::of_rows(std::move(report), followed_.map());
}

}  // namespace riffler
