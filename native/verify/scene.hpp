// The scene of a verification: stock, part and fixtures, divided into slabs and prepared once.
#pragma once

#include <memory>
#include <vector>

#include "riffler/verify/arguments.hpp"
#include "riffler/verify/report.hpp"
#include "verify/slab_job.hpp"
#include "verify/toolset.hpp"

namespace riffler::verify {

/// Several consecutive runs may share a scene. Only its toolset changes, which adds the tools of programs.
class VerifyScene {
 public:
  /// Throws std::invalid_argument naming the argument.
  explicit VerifyScene(VerifyArguments arguments, const Progress& progress = {});

  const Volume& stock() const { return given_.stock; }
  const std::vector<Volume>& fixtures() const { return given_.fixtures; }
  /// The part with outward triangles; null without a part.
  const std::shared_ptr<const Mesh>& part() const { return given_.part; }
  /// Null without a part.
  const Target* target() const { return target_.get(); }
  const VerifyOptions& options() const { return given_.options; }
  Toolset& tools() { return tools_; }
  const Toolset& tools() const { return tools_; }
  /// z above which there is nothing, mm.
  double top() const { return top_; }
  /// All slabs of the stock, then those of the fixtures.
  const std::vector<SlabJob>& jobs() const { return jobs_; }
  /// Material of the part that the stock lacks.
  const std::vector<Event>& missing() const { return missing_; }
  /// mm³: a smaller volume may be rounding.
  double least_cut() const { return options().tolerance * stock().reference().least_area(); }

  /// The slabs before the first move.
  std::vector<SlabState> fresh() const;
  /// The part's material in a slab; empty without a part, and for fixtures.
  SlabTiles part_in(const SlabJob& job) const;
  const dexel::Grid& grid_of(const SlabJob& job) const;
  /// Runs the moves on every slab from its current state. `keep`: whether slabs keep snapshots.
  void simulate(const Moves& moves, std::vector<SlabState>& slabs, bool keep, VerifyStats& stats,
                const Progress& progress) const;

 private:
  void add_jobs(const Volume& volume, std::int32_t fixture);
  void find_missing_material();

  VerifyArguments given_;
  double top_;
  Toolset tools_;
  std::unique_ptr<const Target> target_;
  std::vector<SlabJob> jobs_;
  std::vector<Event> missing_;
};

}  // namespace riffler::verify
