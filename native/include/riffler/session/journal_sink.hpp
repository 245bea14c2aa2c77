// The strokes of a session into a journal on disk.
#pragma once

#include <memory>
#include <string>

#include "riffler/session/journal_file.hpp"
#include "riffler/session/journal_stream_options.hpp"
#include "riffler/session/stroke_sink.hpp"

namespace riffler::session {

class JournalSink final : public StrokeSink {
 public:
  /// Of strokes with that tool, which is in the journal that `writer` writes. Its keeper runs from now on.
  JournalSink(std::unique_ptr<JournalWriter> writer, int tool, double tolerance,
              const JournalStreamOptions& options = {});
  ~JournalSink() override;

  bool room() noexcept override;
  void begin(double time, const Pose& tool) noexcept override;
  void row(double time, const Pose& tool, const Wrench& wrench, double removed) noexcept override;
  void end() noexcept override;
  void undo(std::size_t strokes) noexcept override;
  void redo(std::size_t strokes) noexcept override;

  /// Nobody calls the functions above any more: everything is on the disk, and the file is closed. False where the disk
  /// refuses some of it: problem() says why.
  bool close();
  /// Any thread: why rows wait, or were refused; empty where all is well.
  std::string problem() const;
  std::size_t waiting() const noexcept;
  bool written(double seconds) const;

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace riffler::session
