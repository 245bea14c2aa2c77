#include "session/journal_sink.hpp"

#include <utility>

namespace riffler::session {

JournalSink::JournalSink(std::unique_ptr<JournalWriter> writer, int tool, double tolerance,
                         const JournalStream::Options& options)
    : writer_(std::move(writer)), stream_(*writer_, options), tool_(tool), tolerance_(tolerance) {
  stream_.start();
}

/// For what was taken back, the beginning of a stroke and a row.
bool JournalSink::room() noexcept {
  return stream_.room(3) && settle();
}

void JournalSink::begin(double time, const Pose& tool) noexcept {
  stream_.begin(tool_, tolerance_, {tool, time, {}, 0});
}

void JournalSink::row(double time, const Pose& tool, const Wrench& wrench, double removed) noexcept {
  stream_.put({tool, time, wrench, removed});
}

void JournalSink::end() noexcept {
  stream_.end();
}

void JournalSink::owe(int strokes) noexcept {
  owed_ += strokes;
  settle();
}

bool JournalSink::settle() noexcept {
  if (owed_ != 0 && stream_.count_back(owed_)) owed_ = 0;
  return owed_ == 0;
}

bool JournalSink::close() {
  stream_.end();
  bool done = stream_.stop();
  if (!settle()) done = false;
  if (owed_ == 0 && stream_.waiting() > 0) done = stream_.stop();
  writer_->close();
  return done;
}

}  // namespace riffler::session
