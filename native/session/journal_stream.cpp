#include "session/journal_stream.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "pen/driver.hpp"
#include "riffler/base/check.hpp"

namespace riffler::session {

namespace {

/// Rows per record: about 250 kB.
constexpr std::size_t kPiece = 4096;

void add(JournalStroke& to, const JournalRow& row) {
  to.poses.push_back(row.pose);
  to.times.push_back(row.time);
  to.forces.push_back(row.force);
  to.removed.push_back(row.removed);
}

void check(const JournalStream::Options& options) {
  if (options.rows < 4) throw std::invalid_argument("rows must be 4 or more");
  constexpr const char* kSeconds = "must be positive, in s";
  base::require_positive(options.drain, "drain", kSeconds), base::require_positive(options.sync, "sync", kSeconds);
  base::require_positive(options.retry, "retry", kSeconds);
}

constexpr double kNever = -std::numeric_limits<double>::infinity();

}  // namespace

JournalStream::JournalStream(JournalWriter& writer, const Options& options)
    : writer_(writer), options_(options), synced_at_(kNever), retry_at_(kNever) {
  check(options);
  ring_.resize(options.rows);
}

JournalStream::~JournalStream() {
  stop();
}

// --- The loop ---

bool JournalStream::room(std::size_t rows) const noexcept {
  const std::uint64_t used = head_.load(std::memory_order_relaxed) - tail_.load(std::memory_order_acquire);
  return ring_.size() - used > rows;  // one more, for the end mark
}

bool JournalStream::push(const Slot& slot, std::size_t spare) noexcept {
  if (!room(spare)) return false;
  const std::uint64_t head = head_.load(std::memory_order_relaxed);
  ring_[head % ring_.size()] = slot;
  head_.store(head + 1, std::memory_order_release);
  return true;
}

bool JournalStream::begin(int tool, double tolerance, const JournalRow& row) noexcept {
  if (in_stroke_) return false;
  return in_stroke_ = push({row, tolerance, tool, Kind::Begin}, 1);
}

bool JournalStream::put(const JournalRow& row) noexcept {
  return in_stroke_ && push({row, 0, 0, Kind::Row}, 1);
}

void JournalStream::end() noexcept {
  if (in_stroke_) push({{}, 0, 0, Kind::End}, 0);
  in_stroke_ = false;
}

bool JournalStream::count_back(int strokes) noexcept {
  return !in_stroke_ && push({{}, 0, strokes, Kind::Back}, 1);
}

// --- The writer thread ---

void JournalStream::pop(std::size_t n) {
  tail_.store(tail_.load(std::memory_order_relaxed) + n, std::memory_order_release);
}

std::size_t JournalStream::waiting() const noexcept {
  const std::uint64_t tail = tail_.load(std::memory_order_acquire);
  return static_cast<std::size_t>(head_.load(std::memory_order_acquire) - tail);
}

bool JournalStream::written(double seconds) const {
  const std::uint64_t head = head_.load(std::memory_order_acquire);
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (tail_.load(std::memory_order_acquire) < head) {
    if (std::chrono::steady_clock::now() >= give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

void JournalStream::write_all() {
  const std::uint64_t end = head_.load(std::memory_order_acquire);
  while (write_next(end)) {
  }
}

/// Writes one mark, or the rows up to the next mark; false at the end. If it throws, they stay in the ring.
bool JournalStream::write_next(std::uint64_t end) {
  const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
  if (tail == end) return false;
  const Slot& first = slot(tail);
  if (first.kind == Kind::Begin) {
    begun_ = {first.tool, first.tolerance, first.row};
    pop(1);
  } else if (first.kind == Kind::End) {
    ended_ = ended_ || open_;
    begun_.reset(), open_ = false;
    pop(1);
  } else if (first.kind == Kind::Back) {
    write_count(first.tool);
    pop(1);
  } else if (begun_ && stands(begun_->row.pose, first.row.pose)) {
    // A tool that does not move cuts nothing: the stroke begins at its last position.
    begun_->row = first.row;
    pop(1);
  } else {
    std::uint64_t last = tail + 1;
    while (last != end && last - tail < kPiece && slot(last).kind == Kind::Row) ++last;
    write_rows(tail, last);
  }
  return true;
}

void JournalStream::write_count(int strokes) {
  try {
    if (strokes < 0)
      writer_.undo(static_cast<std::size_t>(-strokes));
    else
      writer_.redo(static_cast<std::size_t>(strokes));
    unsynced_ = ended_ = true;
  } catch (const std::invalid_argument& e) {
    const std::scoped_lock lock(told_);
    refusal_ = e.what();
  }
}

void JournalStream::write_rows(std::uint64_t begin, std::uint64_t end) {
  const auto rows = static_cast<std::size_t>(end - begin);
  piece_.poses.clear(), piece_.times.clear(), piece_.forces.clear(), piece_.removed.clear();
  if (begun_) add(piece_, begun_->row);
  for (std::uint64_t k = begin; k < end; ++k) add(piece_, slot(k).row);
  try {
    if (begun_) {
      piece_.tool = begun_->tool, piece_.tolerance = begun_->tolerance, piece_.mode = options_.mode;
      writer_.add_stroke(piece_);
    } else if (open_) {
      writer_.extend_stroke(piece_.rows());
    } else {
      refused_.fetch_add(rows, std::memory_order_relaxed);  // the stroke has refused rows already
      return pop(rows);
    }
    open_ = unsynced_ = true;
  } catch (const std::invalid_argument& e) {
    if (rows > 1) return write_rows(begin, begin + rows / 2);  // split until the invalid row is found
    // A retry would not help, and rows after a gap would form moves that never happened.
    refused_.fetch_add(piece_.poses.size(), std::memory_order_relaxed);
    open_ = false;
    const std::scoped_lock lock(told_);
    refusal_ = e.what();
  }
  begun_.reset();
  pop(rows);
}

/// Whether everything in the ring at the call is in the file.
bool JournalStream::write(double now) {
  const std::scoped_lock lock(writing_);
  if (now < retry_at_) return false;
  std::string problem;
  try {
    write_all();
  } catch (const std::exception& e) {
    problem = e.what();
    retry_at_ = now + options_.retry;
  }
  const std::scoped_lock telling(told_);
  write_problem_ = problem;
  return problem.empty();
}

/// Whether a sync is due; true once per occasion.
bool JournalStream::sync_due(double now) {
  const std::scoped_lock lock(writing_);
  if (!unsynced_ || !(ended_ || now - synced_at_ >= options_.sync)) return false;
  unsynced_ = ended_ = false;
  synced_at_ = now;
  return true;
}

/// Allows writing by other threads meanwhile: a disk may take seconds.
bool JournalStream::sync() {
  std::string problem;
  try {
    writer_.sync();
  } catch (const std::exception& e) {
    problem = e.what();
    const std::scoped_lock lock(writing_);
    unsynced_ = true;
  }
  const std::scoped_lock telling(told_);
  sync_problem_ = problem;
  return problem.empty();
}

void JournalStream::step(double now) {
  write(now);
  if (sync_due(now)) sync();
}

void JournalStream::use(const std::function<void(JournalWriter&)>& f) {
  const std::scoped_lock lock(writing_);
  write_all();
  if (begun_ || open_) throw std::runtime_error("a stroke is being recorded: end it first");
  f(writer_);
  unsynced_ = ended_ = true;
}

std::string JournalStream::problem() const {
  if (!home_.here()) return "the journal is written by another process";
  const std::scoped_lock lock(told_);
  if (!write_problem_.empty()) return write_problem_;
  if (!sync_problem_.empty()) return sync_problem_;
  return refusal_.empty() ? "" : std::to_string(refused()) + " rows were refused: " + refusal_;
}

// --- Threads ---

void JournalStream::start() {
  if (keeper_.joinable()) return;
  stopping_ = sync_wanted_ = false;
  syncer_ = base::OwnThread([this] { keep_synced(); });
  keeper_ = base::OwnThread([this] { keep(); });
}

void JournalStream::keep() {
  const std::chrono::duration<double> pause(options_.drain);
  std::unique_lock lock(sleeping_);
  while (!stopping_) {
    lock.unlock();
    const double now = pen::steady_seconds();
    write(now);
    const bool due = sync_due(now);
    lock.lock();
    if (due) sync_wanted_ = true, wake_->notify_all();
    wake_->wait_for(lock, pause, [this] { return stopping_; });
  }
}

void JournalStream::keep_synced() {
  std::unique_lock lock(sleeping_);
  while (true) {
    wake_->wait(lock, [this] { return stopping_ || sync_wanted_; });
    if (stopping_) return;
    sync_wanted_ = false;
    lock.unlock();
    sync();
    lock.lock();
  }
}

bool JournalStream::stop() {
  if (!home_.here()) return false;
  {
    const std::scoped_lock lock(sleeping_);
    stopping_ = true;
  }
  wake_->notify_all();
  keeper_.join();
  syncer_.join();
  const auto at_once = [this] {
    const std::scoped_lock lock(writing_);
    retry_at_ = kNever;
  };
  at_once();
  const bool written = write(pen::steady_seconds());
  at_once();
  return sync() && written;
}

}  // namespace riffler::session
