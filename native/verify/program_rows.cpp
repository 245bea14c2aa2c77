#include "verify/program_rows.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "riffler/sweep/carve.hpp"
#include "verify/timing.hpp"

namespace riffler::verify {

void RowChunk::for_moves(std::size_t first, std::span<const ToolShapes> shapes, double top, const Progress& progress,
                         const std::function<void(const Moves&, const Progress&)>& f) const {
  const std::size_t n = program.size();
  const auto share = [&](std::size_t row) { return static_cast<double>(row) / static_cast<double>(n); };
  for (std::size_t begin = first; begin < n; begin += kMovesAtOnce) {
    const std::size_t end = std::min(n, begin + kMovesAtOnce);
    Moves moves(std::span(program.poses()).subspan(begin - 1, end - begin + 1), 1, shapes, top);
    for (std::size_t row = begin; row < end; ++row)
      moves.add(first_row + static_cast<std::int64_t>(row), tool[row], program.rapid()[row] != 0);
    moves.finish();
    f(moves, base::part(progress, share(begin), share(end)));
  }
}

RowChunk ProgramRows::open(const nc::Program& program, Toolset& tools) {
  if (last_ && (last_->tip != program.poses()[0].tip || last_->axis != program.poses()[0].axis))
    throw std::invalid_argument(
        "program: a chunk must begin with the row at which the one before ended; the one after row " +
        std::to_string(seconds_.size() - 1) + " does not");
  sweep::check_path(program.poses());
  const std::int64_t first_row = last_ ? static_cast<std::int64_t>(seconds_.size()) - 1 : 0;
  RowChunk chunk{program, first_row, !last_, tools.places(program, first_row)};
  removed_.resize(static_cast<std::size_t>(first_row) + program.size());
  return chunk;
}

void ProgramRows::close(const RowChunk& chunk, double rapid_feed, const MachineChoice* machine) {
  const nc::Program& program = chunk.program;
  add_notes(program.notes);
  if (machine)
    if (auto fault = machine_fault(program, chunk.first_row, *machine)) faults_.push_back(std::move(*fault));
  if (chunk.start) seconds_.push_back(0);
  for (std::size_t row = 1; row < program.size(); ++row) {
    seconds_.push_back(seconds_of(program.poses()[row - 1], program, row, rapid_feed));
    if (!program.moves_in_part(row)) continue;
    if (chunk.tool[row] == kNoTool)
      without_tool_ = true;
    else
      tools_.insert(chunk.tool[row]);
    if (program.spindle()[row] == 0 && !program.rapid()[row])
      standing_.push_back({chunk.first_row + static_cast<std::int64_t>(row), program.poses()[row].tip});
  }
  const auto first = static_cast<std::ptrdiff_t>(chunk.start ? 0 : 1);
  tool_.insert(tool_.end(), program.tool().begin() + first, program.tool().end());
  line_.insert(line_.end(), program.line().begin() + first, program.line().end());
  last_ = program.poses().back();
}

void ProgramRows::add_notes(const std::vector<nc::Note>& notes) {
  for (const nc::Note& n : notes)
    if (std::ranges::find(notes_, n) == notes_.end()) notes_.push_back(n);
}

void ProgramRows::add_removed(const SlabReport& report) {
  for (const auto& [row, taken] : report.removed) removed_[static_cast<std::size_t>(row)] += taken;
}

void ProgramRows::add_spindle(double least, std::vector<Event>& events) const {
  for (const StandingMove& move : standing_)
    if (const double taken = removed_[static_cast<std::size_t>(move.row)]; taken > least)
      events.push_back({Kind::Spindle, Member::Cutter, -1, move.row, taken, taken, move.tip});
}

void ProgramRows::settle() {
  tool_.clear(), line_.clear(), standing_.clear();
}

}  // namespace riffler::verify
