#include "nc/write/row_check.hpp"

#include <stdexcept>

#include "nc/follow.hpp"
#include "nc/limits.hpp"
#include "nc/machine/machines.hpp"
#include "nc/write/block_maker.hpp"

namespace riffler::nc {

namespace {

class NoBlocks final : public BlockSink {
 public:
  void change_tool(int, const Tool*, bool) override {}
  void spindle(double) override {}
  void ready(int) override {}
  void block(const PostBlock&) override {}
  void arc(const PostArc&) override {}
};

/// Converts the report on a followed program into one on the original program.
void count_original_rows(WriteReport& report, const RowMap& map) {
  for (std::size_t& row : report.rewinds) row = map.original(row);
  for (MachineStep& m : report.motion) m.row = map.original(m.row);
  for (PolePassage& p : report.passages) p.first = map.original(p.first), p.last = map.original(p.last);
}

}  // namespace

RowCheck::RowCheck(const WriteOptions& options) : options_(options) {
  OptionReader taken(options.options, "post " + options.post);
  machine_ = make_machine(options.post, taken);
  how_ = take_post_options(taken, machine_->control().coolant);
  const std::unique_ptr<Post> post = make_post();
  joints_ = post->wants_joints();
  arcs_ = how_.arcs && post->has_arcs();
  taken.done();
  if (!(options.tolerance >= 2e-5 && options.tolerance <= kMaxLength))
    throw std::invalid_argument("tolerance must be a length of at least 0.00002 mm: lengths have 5 decimals");
  if (!(options.axis_tolerance >= 1e-7 && options.axis_tolerance <= 1))
    throw std::invalid_argument("axis_tolerance must be at least 1e-7 rad (angles have 6 decimals) and at most 1");
}

std::optional<RowError> RowCheck::first_fault(const Program& program) const {
  NoBlocks sink;
  WriteReport report;
  return first_fault(program, sink, report);
}

std::optional<RowError> RowCheck::first_fault(const Program& program, BlockSink& sink, WriteReport& report) const {
  RowMap map;
  const bool follows = !program.via().empty();
  Program whole;
  try {
    if (follows) whole = followed(program, &map);
  } catch (const RowError& e) {  // a via pose without a feed
    return e;
  }
  const BlockSettings settings{*machine_, options_.tolerance, options_.axis_tolerance, how_.safe_height, joints_,
                               arcs_,     options_.motion};
  try {
    report = make_blocks(follows ? whole : program, settings, sink);
  } catch (const RowError& e) {
    if (!follows) return e;
    return RowError(e.name(), map.original(e.row()), (e.name() == "poses" ? "on the move there " : "") + e.reason());
  }
  if (follows) count_original_rows(report, map);
  return std::nullopt;
}

}  // namespace riffler::nc
