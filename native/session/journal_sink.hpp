// The strokes of a session into a journal on disk.
#pragma once

#include <memory>
#include <string>

#include "session/journal_stream.hpp"
#include "session/stroke_sink.hpp"

namespace riffler::session {

class JournalSink final : public StrokeSink {
 public:
  /// Of strokes with that tool, which is in the journal that `writer` writes. Its keeper runs from now on.
  JournalSink(std::unique_ptr<JournalWriter> writer, int tool, double tolerance,
              const JournalStream::Options& options = {});

  bool room() noexcept override;
  void begin(double time, const Pose& tool) noexcept override;
  void row(double time, const Pose& tool, const Wrench& wrench, double removed) noexcept override;
  void end() noexcept override;
  void undo(std::size_t strokes) noexcept override { owe(-static_cast<int>(strokes)); }
  void redo(std::size_t strokes) noexcept override { owe(static_cast<int>(strokes)); }

  /// Nobody calls the functions above any more: everything is on the disk, and the file is closed. False where the disk
  /// refuses some of it: problem() says why.
  bool close();
  /// Any thread: why rows wait, or were refused; empty where all is well.
  std::string problem() const { return stream_.problem(); }
  std::size_t waiting() const noexcept { return stream_.waiting(); }
  bool written(double seconds) const { return stream_.written(seconds); }

 private:
  void owe(int strokes) noexcept;
  bool settle() noexcept;

  std::unique_ptr<JournalWriter> writer_;
  JournalStream stream_;
  int tool_;
  double tolerance_;
  int owed_ = 0;  // strokes to be taken back (< 0) or brought back, for which there was no room
};

}  // namespace riffler::session
