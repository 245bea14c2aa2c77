// Writes the strokes of a session to a journal on disk.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "riffler/session/journal_file.hpp"
#include "riffler/session/journal_stream_options.hpp"
#include "riffler/session/stroke_sink.hpp"

namespace riffler::session {

/// Keys and values of Journal::notes().
using JournalNotes = std::vector<std::pair<std::string, std::string>>;

/// A StrokeSink that writes to a JournalWriter through a ring buffer and a thread of its own.
class JournalSink final : public StrokeSink {
 public:
  /// Records strokes made with tool number `tool`, which must be in the journal of `writer`, carved with `tolerance`
  /// (mm). Starts the writing thread.
  JournalSink(std::unique_ptr<JournalWriter> writer, int tool, double tolerance,
              const JournalStreamOptions& options = {});
  ~JournalSink() override;

  bool room() noexcept override;
  void begin(double time, const Pose& tool) noexcept override;
  void row(double time, const Pose& tool, const Wrench& wrench, double removed) noexcept override;
  void end() noexcept override;
  void undo(std::size_t strokes) noexcept override;
  void redo(std::size_t strokes) noexcept override;

  /// Call it when none of the functions above is called any more: writes everything and `notes` to disk, and closes the
  /// file. Returns false if the disk refuses some of it; see problem().
  bool close(const JournalNotes& notes = {});
  /// Why rows wait or were refused; empty if all is well. Any thread.
  std::string problem() const;
  /// Number of rows not written yet.
  std::size_t waiting() const noexcept;
  /// Waits up to `seconds` for all rows to be written; whether they are.
  bool written(double seconds) const;

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace riffler::session
