// Checks whether a machine can run the rows of a program: axis limits, orientations it cannot hold, paths that its
// rotary axes cannot follow, unknown feeds.
#pragma once

#include <memory>
#include <optional>

#include "nc/write/post.hpp"
#include "riffler/nc/program.hpp"
#include "riffler/nc/write/write_options.hpp"

namespace riffler::nc {

/// The common check of writer and verification. The joints of a row depend on the rows before and after it
/// (nc/write/rotary.hpp), so rows are checked together.
class RowCheck {
 public:
  /// Throws std::invalid_argument for an unknown machine or option, or a tolerance that is too small.
  explicit RowCheck(const WriteOptions& options);

  const Machine& machine() const { return *machine_; }
  /// The post for the machine's language.
  std::unique_ptr<Post> make_post() const { return nc::make_post(*machine_, how_); }

  /// The first row that the machine cannot run, or no value. Writes nothing.
  std::optional<RowError> first_fault(const Program& program) const;
  /// As above. Passes the blocks before the fault to `sink`; sets `report` only if there is no fault.
  std::optional<RowError> first_fault(const Program& program, BlockSink& sink, WriteReport& report) const;

 private:
  WriteOptions options_;
  std::unique_ptr<Machine> machine_;
  PostOptions how_;
  bool joints_ = true, arcs_ = false;  // for BlockSettings
};

}  // namespace riffler::nc
