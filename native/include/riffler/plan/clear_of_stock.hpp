// Leaves out the moves of an operation in which shank or holder would touch the stock.
#pragma once

#include <optional>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/plan/operation.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// What happens around a place that is left out. Lengths in mm.
struct StockRule {
  enum class After {
    Resume,  ///< the tool leaves, and comes down again behind the place
    Leave,  ///< the tool leaves until its next approach. Later moves nearby and not higher are left out, too: they were
            ///< planned for material that is now still there
    Whole   ///< all moves from the approach to the retract are left out
  };
  After after = After::Resume;
  double nearby = 0;            ///< between the tips of two moves, seen along the axis: see `Leave`
  double tolerance = 0.01;      ///< of the cuts
  double part_distance = 0;     ///< of the whole tool from the part in new leads, less the tolerance
  double fixture_distance = 0;  ///< the same for fixtures
  double plunge = 100;          ///< feed of new leads, mm/min
};

/// Simulates an operation on the set-up's stock, and leaves out the moves in which shank, holder, or what lies above
/// the described tool would touch the material that is there by then. Whole moves are tested (BodyProbe), not samples.
/// What is left out is added to `operation.blocked`. Returns what each move removes, mm³. If nothing is left out, the
/// operation does not change. The operation begins and ends at one height, above all of part, fixtures and stock.
/// Throws std::invalid_argument for poses that `sweep::carve` refuses.
std::vector<double> clear_of_stock(const SetupScene& scene, const Tool& tool, Operation& operation,
                                   const StockRule& rule, const Progress& progress = {});

}  // namespace riffler::plan
