// Events of rows → findings of neighbouring rows.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "riffler/nc/program.hpp"
#include "riffler/verify/report.hpp"
#include "verify/event.hpp"

namespace riffler::verify {

/// Takes events in stretches of ascending rows.
class FindingList {
 public:
  /// `tool` and `line`: of the program's rows from number `first_row` on. Of several events of one row and kind, the
  /// order does not matter but for sums.
  void add(std::vector<Event> events, std::span<const std::int32_t> tool, std::span<const std::int32_t> line,
           std::int64_t first_row);
  /// Sorted by rows, with their messages.
  std::vector<Finding> take();

 private:
  void add_row(const Event& event, std::int32_t tool, std::int32_t line);

  std::vector<Finding> findings_;
  std::map<std::pair<Kind, std::int32_t>, std::size_t> open_;  // the last one of a kind and a fixture
};

/// One sentence that says what happened and what to do.
std::string message_of(const Finding& finding);

/// The message of a finding of Kind::Unknown, which depends on how far its tool is described.
std::string message_of_unknown(const Finding& finding, const Tool& tool);

}  // namespace riffler::verify
