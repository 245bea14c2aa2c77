#include "verify/program_rows.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "sweep/carve.hpp"
#include "verify/timing.hpp"

namespace riffler {

std::vector<StandingMove> standing_moves(const Program& program, std::int64_t first_row) {
  std::vector<StandingMove> out;
  for (std::size_t row = 1; row < program.size(); ++row)
    if (program.moves_in_part(row) && program.spindle()[row] == 0 && !program.rapid()[row])
      out.push_back({first_row + static_cast<std::int64_t>(row), program.poses()[row].tip});
  return out;
}

void add_spindle(std::span<const StandingMove> moves, std::span<const double> removed, std::int64_t first_row,
                 double least, std::vector<Event>& events) {
  for (const StandingMove& move : moves)
    if (const double taken = removed[static_cast<std::size_t>(move.row - first_row)]; taken > least)
      events.push_back({Kind::Spindle, Member::Cutter, -1, move.row, taken, taken, move.tip});
}

void ProgramRows::Chunk::for_moves(std::span<const ToolShapes> shapes, double top, const Progress& progress,
                                   const std::function<void(const Moves&, const Progress&)>& f) const {
  const std::size_t n = program.size();
  const auto share = [&](std::size_t row) { return static_cast<double>(row) / static_cast<double>(n); };
  for (std::size_t begin = 1; begin < n; begin += kMovesAtOnce) {
    const std::size_t end = std::min(n, begin + kMovesAtOnce);
    Moves moves(std::span(program.poses()).subspan(begin - 1, end - begin + 1), 1, shapes, top);
    for (std::size_t row = begin; row < end; ++row)
      moves.add(first_row + static_cast<std::int64_t>(row), tool[row], program.rapid()[row] != 0);
    moves.finish();
    f(moves, part(progress, share(begin), share(end)));
  }
}

ProgramRows::Chunk ProgramRows::open(const Program& program, Toolset& tools) const {
  if (last_ && (last_->tip != program.poses()[0].tip || last_->axis != program.poses()[0].axis))
    throw std::invalid_argument(
        "program: a chunk must begin with the row at which the one before ended; the one after row " +
        std::to_string(seconds_.size() - 1) + " does not");
  check_path(program.poses());
  const std::int64_t first_row = last_ ? static_cast<std::int64_t>(seconds_.size()) - 1 : 0;
  return {program, first_row, !last_, tools.places(program, first_row)};
}

void ProgramRows::close(const Chunk& chunk, double rapid_feed, const MachineChoice* machine) {
  for (const Note& n : chunk.program.notes)
    if (std::ranges::find(notes_, n) == notes_.end()) notes_.push_back(n);
  if (machine)
    if (auto fault = machine_fault(chunk.program, chunk.first_row, *machine)) faults_.push_back(std::move(*fault));
  if (chunk.start) seconds_.push_back(0);
  for (std::size_t row = 1; row < chunk.program.size(); ++row) {
    seconds_.push_back(seconds_of(chunk.program.poses()[row - 1], chunk.program, row, rapid_feed));
    if (!chunk.program.moves_in_part(row)) continue;
    if (chunk.tool[row] == kNoTool)
      without_tool_ = true;
    else
      tools_.insert(chunk.tool[row]);
  }
  last_ = chunk.program.poses().back();
}

}  // namespace riffler
