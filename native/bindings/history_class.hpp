// riffler.History.
#pragma once

#include "bindings/results.hpp"

namespace riffler::bindings {

RIFFLER_TYPED(HistoryStrokeResult, "riffler.results.HistoryStroke")
RIFFLER_TYPED(HistoryStatsResult, "riffler.results.HistoryStats")

void bind_history(py::module_& m);

}  // namespace riffler::bindings
