// Combines events of rows into findings of neighbouring rows.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "riffler/nc/program.hpp"
#include "riffler/verify/report.hpp"
#include "verify/event.hpp"

namespace riffler::verify {

/// Takes events in batches of ascending rows.
class FindingList {
 public:
  /// `tool` and `line`: columns of the program's rows from number `first_row` on. The order of events with the same row
  /// and kind affects only the rounding of sums.
  void add(std::vector<Event> events, std::span<const std::int32_t> tool, std::span<const std::int32_t> line,
           std::int64_t first_row);
  /// The findings sorted by rows, with messages.
  std::vector<Finding> take();

 private:
  void add_row(const Event& event, std::int32_t tool, std::int32_t line);

  std::vector<Finding> findings_;
  std::map<std::pair<Kind, std::int32_t>, std::size_t> open_;  // the last finding per kind and fixture
};

/// One sentence: what happened and what to do.
std::string message_of(const Finding& finding);

/// The message of a finding of Kind::Unknown, which depends on how far the tool's shape is described.
std::string message_of_unknown(const Finding& finding, const Tool& tool);

}  // namespace riffler::verify
