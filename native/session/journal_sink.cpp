#include "riffler/session/journal_sink.hpp"

#include <exception>
#include <utility>

#include "session/journal_stream.hpp"

namespace riffler::session {

struct JournalSink::Core {
  Core(std::unique_ptr<JournalWriter> writer, int tool, double tolerance, const JournalStreamOptions& options)
      : writer_(std::move(writer)), stream_(*writer_, options), tool_(tool), tolerance_(tolerance) {
    stream_.start();
  }
  void owe(int strokes) noexcept;
  bool settle() noexcept;
  bool add(const JournalNotes& notes);

  std::unique_ptr<JournalWriter> writer_;
  JournalStream stream_;
  int tool_;
  double tolerance_;
  int owed_ = 0;  // pending undo (< 0) or redo of strokes, for lack of room
  std::string note_problem_;
};

JournalSink::JournalSink(std::unique_ptr<JournalWriter> writer, int tool, double tolerance,
                         const JournalStreamOptions& options)
    : core_(std::make_unique<Core>(std::move(writer), tool, tolerance, options)) {}

JournalSink::~JournalSink() = default;

/// Room for a pending undo, the beginning of a stroke and a row.
bool JournalSink::room() noexcept {
  return core_->stream_.room(3) && core_->settle();
}

void JournalSink::begin(double time, const Pose& tool) noexcept {
  core_->stream_.begin(core_->tool_, core_->tolerance_, {tool, time, {}, 0});
}

void JournalSink::row(double time, const Pose& tool, const Wrench& wrench, double removed) noexcept {
  core_->stream_.put({tool, time, wrench, removed});
}

void JournalSink::end() noexcept {
  core_->stream_.end();
}

void JournalSink::undo(std::size_t strokes) noexcept {
  core_->owe(-static_cast<int>(strokes));
}

void JournalSink::redo(std::size_t strokes) noexcept {
  core_->owe(static_cast<int>(strokes));
}

void JournalSink::Core::owe(int strokes) noexcept {
  owed_ += strokes;
  settle();
}

bool JournalSink::Core::settle() noexcept {
  if (owed_ != 0 && stream_.count_back(owed_)) owed_ = 0;
  return owed_ == 0;
}

/// False if the disk refuses them.
bool JournalSink::Core::add(const JournalNotes& notes) {
  try {
    stream_.use([&](JournalWriter& writer) {
      for (const auto& [key, value] : notes) writer.add_note(key, value);
      writer.sync();
    });
  } catch (const std::exception& e) {
    note_problem_ = e.what();
  }
  return note_problem_.empty();
}

bool JournalSink::close(const JournalNotes& notes) {
  Core& core = *core_;
  core.stream_.end();
  bool done = core.stream_.stop();
  if (!core.settle()) done = false;
  if (core.owed_ == 0 && core.stream_.waiting() > 0) done = core.stream_.stop();
  if (done && !notes.empty()) done = core.add(notes);
  core.writer_->close();
  return done;
}

std::string JournalSink::problem() const {
  const std::string problem = core_->stream_.problem();
  return problem.empty() ? core_->note_problem_ : problem;
}

std::size_t JournalSink::waiting() const noexcept {
  return core_->stream_.waiting();
}

bool JournalSink::written(double seconds) const {
  return core_->stream_.written(seconds);
}

}  // namespace riffler::session
