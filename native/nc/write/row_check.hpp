// Whether a machine can run the rows of a program: axes out of their limits, orientations that it cannot hold, ways
// that its rotary axes cannot follow, feeds that are not known.
#pragma once

#include <memory>
#include <optional>

#include "nc/write/post.hpp"
#include "riffler/nc/program.hpp"
#include "riffler/nc/write/write_options.hpp"

namespace riffler::nc {

/// The one check of writer and verification. Where the axes stand at a row follows from the rows before and after it
/// (nc/write/rotary.hpp), so rows are checked together.
class RowCheck {
 public:
  /// std::invalid_argument for a machine or an option that is not known, or a tolerance that is too small.
  explicit RowCheck(const WriteOptions& options);

  const Machine& machine() const { return *machine_; }
  /// Writes in the machine's language.
  std::unique_ptr<Post> make_post() const { return nc::make_post(*machine_, how_); }

  /// The first row that the machine cannot run, or nothing. Writes nothing.
  std::optional<RowError> first_fault(const Program& program) const;
  /// The same. Hands the blocks before the fault to `sink`; `report` changes where there is none.
  std::optional<RowError> first_fault(const Program& program, BlockSink& sink, WriteReport& report) const;

 private:
  WriteOptions options_;
  std::unique_ptr<Machine> machine_;
  PostOptions how_;
  bool joints_ = true, arcs_ = false;  // of BlockSettings
};

}  // namespace riffler::nc
