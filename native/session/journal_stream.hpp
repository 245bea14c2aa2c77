// Stream from the haptic loop to the journal: the loop never waits for the disk, and checks before a cut that it can
// still be recorded.
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

/// A row of a stroke in the loop; fields as the columns of JournalRows.
struct JournalRow {
  Pose pose;
  double time = 0;
  Wrench force{};
  double removed = 0;
};

/// A ring buffer between one loop and a writer thread that writes to a journal and syncs it. Rows leave the ring when
/// they are in the file. While the disk refuses them they wait; when the ring is full, `room` tells the loop to stop
/// cutting. Nothing is dropped: a row that no journal can hold (an invalid pose) is counted and ends its stroke.
class JournalStream {
 public:
  using Options = JournalStreamOptions;

  /// `writer` must outlive this object and is used by the writer thread: see `use`. Allocates all memory here. Throws
  /// std::invalid_argument for options that are not positive, or fewer than 4 rows.
  JournalStream(JournalWriter& writer, const Options& options);
  explicit JournalStream(JournalWriter& writer) : JournalStream(writer, Options()) {}
  JournalStream(const JournalStream&) = delete;
  JournalStream& operator=(const JournalStream&) = delete;
  ~JournalStream();

  // --- For the loop, one thread: none of these waits, allocates or throws. ---

  /// Whether the next `rows` calls of `begin` and `put` will succeed. `end` always does.
  bool room(std::size_t rows = 1) const noexcept;
  /// Begins a stroke at the row's pose with the tool of that number, which is in the journal. Returns false and does
  /// nothing without room, or during a stroke.
  bool begin(int tool, double tolerance, const JournalRow& row) noexcept;
  /// Adds a move from the row before. False without room, or outside a stroke.
  bool put(const JournalRow& row) noexcept;
  void end() noexcept;
  /// Undoes (`strokes` < 0) or redoes (`strokes` > 0) strokes. False without room, or during a stroke.
  bool count_back(int strokes) noexcept;

  // --- For any other thread ---

  /// Starts the writer thread, and a second thread that waits for the disk.
  void start();
  /// Writes and syncs what is there. Returns false if the disk refuses: the rows wait for the next start(). Also false
  /// in a process forked from that of the journal, which leaves the file alone.
  bool stop();
  /// One step of the writer at time `now` (s), for tests and for callers with their own thread. Not after start().
  void step(double now);
  /// Calls `f` with the writer after all rows so far, for example to add tools or notes. Throws std::runtime_error
  /// during a stroke, or if the disk refuses its rows.
  void use(const std::function<void(JournalWriter&)>& f);

  /// For display: why nothing is being written, or what was refused for good; empty if all is well.
  std::string problem() const;
  /// Rows that are not in the file yet; any thread.
  std::size_t waiting() const noexcept;
  /// Waits up to `seconds` until everything present at the call is in the file. False: not yet.
  bool written(double seconds) const;
  /// Number of rows that no journal can hold.
  std::uint64_t refused() const noexcept { return refused_.load(std::memory_order_relaxed); }

 private:
  enum class Kind : std::int32_t { Begin, Row, End, Back };
  struct Slot {
    JournalRow row;
    double tolerance;
    int tool;  // or the number of strokes of an undo or redo
    Kind kind;
  };
  static_assert(sizeof(Slot) == 128, "as Options::rows says");
  struct Begun {  // a stroke not written yet, because it has not moved
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
  alignas(64) std::atomic<std::uint64_t> head_{0};  // the next slot for the loop to fill
  bool in_stroke_ = false;                          // used by the loop
  alignas(64) std::atomic<std::uint64_t> tail_{0};  // the first slot not written yet
  std::atomic<std::uint64_t> refused_{0};

  std::mutex writing_;  // protects the journal writer and the thread's state below
  std::optional<Begun> begun_;
  bool open_ = false;  // the last stroke in the file is unfinished
  JournalStroke piece_;
  bool unsynced_ = false, ended_ = false;  // rows, or the end of a stroke, since the last sync
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
