// The tools of a run, prepared once.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "riffler/nc/program.hpp"
#include "verify/moves.hpp"

namespace riffler::verify {

/// Whether two tools cut and touch alike.
bool same_shape(const Tool& a, const Tool& b);

class Toolset {
 public:
  /// Tools in `own` take precedence over a program's tools of the same number.
  Toolset(std::map<int, Tool> own, double tolerance, double reach, double pitch);

  /// Index in shapes() of each row's tool; kNoTool before the first tool call and for rows that end no motion in the
  /// part. Throws std::invalid_argument naming number, row and line of a number without a shape; rapids before the
  /// first call (number 0) need none. `first_row`: number of the program's row 0.
  std::vector<std::uint32_t> places(const nc::Program& program, std::int64_t first_row);

  const std::vector<ToolShapes>& shapes() const { return shapes_; }
  /// The tools, by index.
  const std::vector<Tool>& tools() const { return tools_; }
  /// The tool registered under `number`, or null; of several the last.
  const Tool* of_number(int number) const;
  double reach() const { return reach_; }
  /// Sentences on what the descriptions of some tools leave out.
  std::vector<std::string> not_described(const std::set<std::uint32_t>& places) const;

 private:
  std::uint32_t place(int number, const Tool& tool);

  std::map<int, Tool> own_;
  double tolerance_, reach_, pitch_;
  std::vector<int> numbers_;
  std::vector<Tool> tools_;
  std::vector<ToolShapes> shapes_;
};

}  // namespace riffler::verify
