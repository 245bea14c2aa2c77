// Events of rows → findings of neighbouring rows.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "nc/program.hpp"
#include "verify/report.hpp"

namespace riffler {

/// Takes events in stretches of ascending rows.
class FindingList {
 public:
  /// `events` of rows of `program`, whose row 0 has the number `first_row`. Of several events of one row and kind, the
  /// order does not matter but for sums.
  void add(std::vector<Event> events, const Program& program, std::int64_t first_row);
  /// Sorted by rows, with their messages.
  std::vector<Finding> take();

 private:
  void add_row(const Event& event, const Program& program, std::int64_t first_row);

  std::vector<Finding> findings_;
  std::map<std::pair<Kind, std::int32_t>, std::size_t> open_;  // the last one of a kind and a fixture
};

/// One sentence that says what happened and what to do.
std::string message_of(const Finding& finding);

}  // namespace riffler
