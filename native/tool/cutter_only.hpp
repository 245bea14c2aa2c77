// The part of a tool that cuts.
#pragma once

#include "riffler/tool/tool.hpp"

namespace riffler::tool {

/// The tool without shank and holder, which cut nothing.
inline Tool cutter_only(const Tool& tool) {
  return Tool(tool.kind(), tool.parameters(), tool.profile());
}

}  // namespace riffler::tool
