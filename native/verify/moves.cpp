#include "verify/moves.hpp"

#include <algorithm>

#include "riffler/base/parallel.hpp"

namespace riffler::verify {

Moves::Moves(std::span<const Pose> poses, std::uint32_t stride, std::span<const ToolShapes> shapes, double top)
    : poses_(poses), stride_(stride), shapes_(shapes), top_(top) {}

void Moves::finish() {
  const std::size_t n = size();
  cutter_.resize(n), probes_.resize(n), blocks_.resize((n + kBlock - 1) / kBlock);
  constexpr std::size_t grain = 16;
  base::parallel_for(blocks_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t i = b * kBlock; i < std::min(n, (b + 1) * kBlock); ++i) {
        if (tool_[i] == kNoTool) continue;
        const ToolShapes& tool = shapes(i);
        cutter_[i] = swept(tool.cutter_rod, i);
        for (const Rod& rod : tool.probe_rods) probes_[i].add(swept(rod, i));
        blocks_[b].add(cutter_[i]), blocks_[b].add(probes_[i]);
      }
  });
}

Moves::Touch Moves::touch(std::size_t i, const Box3& box) const {
  int out = None;
  if (cutter_[i].overlaps(box)) out |= Cutter;
  if (probes_[i].overlaps(box)) {
    const auto meets = [&](const Rod& rod) { return swept(rod, i).overlaps(box); };
    const std::vector<Rod>& rods = shapes(i).probe_rods;
    if (std::any_of(rods.begin(), rods.end(), meets)) out |= Probes;
  }
  return static_cast<Touch>(out);
}

}  // namespace riffler::verify
