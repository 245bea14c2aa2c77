// From the haptic loop to the journal: the loop never waits for the disk, and asks before it cuts whether what it does
// can still be kept.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/own_thread.hpp"
#include "riffler/session/journal_file.hpp"
#include "riffler/session/journal_stream_options.hpp"

namespace riffler::session {

/// A row of a stroke as the loop has it: columns as JournalRows.
struct JournalRow {
  Pose pose;
  double time = 0;
  Wrench force{};
  double removed = 0;
};

/// A ring between one loop and a keeper who writes it to a journal and syncs. Rows leave the ring when they are in the
/// file; while the disk refuses them they wait there, and where the ring is full `room` tells the loop to cut no more.
/// Nothing is dropped: what a journal cannot hold at all (a pose that is none) is counted and ends its stroke.
class JournalStream {
 public:
  using Options = JournalStreamOptions;

  /// `writer` must outlive this, and is the keeper's: see `use`. Takes all its memory here. std::invalid_argument for
  /// options that are not positive, or fewer than 4 rows.
  JournalStream(JournalWriter& writer, const Options& options);
  explicit JournalStream(JournalWriter& writer) : JournalStream(writer, Options()) {}
  JournalStream(const JournalStream&) = delete;
  JournalStream& operator=(const JournalStream&) = delete;
  ~JournalStream();

  // --- Of the loop, one thread: none of them waits, allocates or throws. ---

  /// Whether the next so many calls of `begin` and `put` will be taken. `end` always is.
  bool room(std::size_t rows = 1) const noexcept;
  /// The tool, whose number is in the journal, stands here. False, and nothing was taken: no room, or in a stroke.
  bool begin(int tool, double tolerance, const JournalRow& row) noexcept;
  /// It moved here, from the row before. False: no room, or no stroke.
  bool put(const JournalRow& row) noexcept;
  void end() noexcept;
  /// So many strokes are taken back (less than zero) or brought back. False: no room, or in a stroke.
  bool count_back(int strokes) noexcept;

  // --- Of any other thread ---

  /// The keeper, and one beside it who waits for the disk, in threads of their own.
  void start();
  /// Writes and syncs what is there. False where the disk refuses: the rows wait for the next start(); and in a process
  /// that was forked from that of the journal, which leaves the file alone.
  bool stop();
  /// What the keeper does at the time `now` (s): for tests, and for those with a thread of their own. Not after
  /// start().
  void step(double now);
  /// Calls `f` with the writer, after all rows so far: tools, notes. std::runtime_error where a stroke has not
  /// ended, or the disk refuses its rows.
  void use(const std::function<void(JournalWriter&)>& f);

  /// For the screen: why nothing is written just now, or what was refused for good; empty: all is well.
  std::string problem() const;
  /// Rows that are not in the file yet; any thread.
  std::size_t waiting() const noexcept;
  /// Waits, up to so many seconds, until all that was there at the call is in the file. False: it is not yet.
  bool written(double seconds) const;
  /// Rows that no journal can hold.
  std::uint64_t refused() const noexcept { return refused_.load(std::memory_order_relaxed); }

 private:
  enum class Kind : std::int32_t { Begin, Row, End, Back };
  struct Slot {
    JournalRow row;
    double tolerance;
    int tool;  // or the strokes that come back
    Kind kind;
  };
  static_assert(sizeof(Slot) == 128, "as Options::rows says");
  struct Begun {  // a stroke of which nothing is written, for it has not moved
    int tool;
    double tolerance;
    JournalRow row;
  };

  bool push(const Slot& slot, std::size_t spare) noexcept;
  const Slot& slot(std::uint64_t number) const { return ring_[number % ring_.size()]; }
  void pop(std::size_t n);
  void write_all();
  bool write_next(std::uint64_t end);
  void write_rows(std::uint64_t begin, std::uint64_t end);
  void write_count(int strokes);
  bool write(double now);
  bool sync();
  bool sync_due(double now);
  void keep();
  void keep_synced();

  JournalWriter& writer_;
  Options options_;
  std::vector<Slot> ring_;
  alignas(64) std::atomic<std::uint64_t> head_{0};  // the next slot that the loop fills
  bool in_stroke_ = false;                          // the loop's
  alignas(64) std::atomic<std::uint64_t> tail_{0};  // the first that the keeper has not written
  std::atomic<std::uint64_t> refused_{0};

  std::mutex writing_;  // the writer, and the keeper's state up to the next line
  std::optional<Begun> begun_;
  bool open_ = false;  // the last stroke in the file goes on
  JournalStroke piece_;
  bool unsynced_ = false, ended_ = false;  // rows, and a stroke's end, since the last sync
  double synced_at_, retry_at_;

  mutable std::mutex told_;
  std::string write_problem_, sync_problem_, refusal_;

  std::mutex sleeping_;
  base::HomeOnly<std::condition_variable> wake_;
  base::HomeProcess home_;
  bool stopping_ = false, sync_wanted_ = false;
  base::OwnThread keeper_, syncer_;
};

}  // namespace riffler::session
