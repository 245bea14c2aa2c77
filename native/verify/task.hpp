// A slab's work as a value: everything it needs, and everything it finds. It can be done anywhere.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mesh/mesh.hpp"
#include "verify/simulate.hpp"

namespace riffler {

struct SlabTask {
  std::int32_t fixture = -1;  ///< −1: of the stock
  std::size_t slab = 0;       ///< place in slabs_of(material)
  Volume material;            ///< of the slab alone (part_of)
  std::vector<Pose> poses;    ///< pairs: the moves that can touch it, from and to
  std::vector<std::int64_t> rows;
  std::vector<std::uint32_t> tool;  ///< places in `tools`
  std::vector<std::uint8_t> rapid;
  std::vector<Tool> tools;
  double tolerance = 0.01, gouge_tolerance = 0.05;  ///< mm
  double beyond = 0;                                ///< mm: how far a tool is taken to go on after its description
  double pitch = 0;                                 ///< of the stock, mm
  double top = 0;                                   ///< z above which there is nothing
  std::shared_ptr<const Mesh> part;                 ///< or null
  std::optional<Volume> target;                     ///< the part over the slab
  std::size_t job = 0;                              ///< whose it is in the verification
};

struct SlabResult {
  std::size_t job = 0;
  Volume material;  ///< what is left of it
  SlabReport report;
  VerifyStats stats;
};

/// The same bytes wherever it runs.
SlabResult simulate(const SlabTask& task);

}  // namespace riffler
