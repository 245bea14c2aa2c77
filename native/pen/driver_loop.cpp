#include "pen/driver_loop.hpp"

#include <algorithm>
#include <stdexcept>

#include "riffler/base/check.hpp"

namespace riffler::pen {

void DriverSettings::validate() const {
  base::require_positive(read_timeout, "read_timeout");
  base::require_positive(late, "late");
  base::require_positive(silence, "silence");
  base::require_positive(first_retry, "first_retry");
  base::require_positive(longest_retry, "longest_retry");
  base::require_positive(poll, "poll");
  base::require_positive(most_reads, "most_reads");
  if (longest_retry < first_retry) throw std::invalid_argument("longest_retry of the driver is less than first_retry");
}

DriverLoop::DriverLoop(PenModel& model, PenStep& step, Connector& connector, Clock& clock,
                       std::unique_ptr<Transport> transport, const DriverSettings& settings)
    : model_(model),
      step_(step),
      connector_(connector),
      clock_(clock),
      settings_(settings),
      read_(model.sizes().read),
      write_(model.sizes().write) {
  settings_.validate();
  status_.retry = settings_.first_retry;
  next_attempt_ = clock_.now();
  if (transport) open(std::move(transport));
  publish();
}

DriverLoop::~DriverLoop() {
  stop();
}

void DriverLoop::tick() noexcept {
  if (status_.state == LinkState::Stopped) return;
  if (status_.state == LinkState::Connected)
    drive();
  else
    look();
  publish();
}

void DriverLoop::stop() noexcept {
  if (transport_) release();
  transport_.reset();
  status_.state = LinkState::Stopped;
  status_.wrench = {};
  publish();
}

void DriverLoop::open(std::unique_ptr<Transport> transport) noexcept {
  transport_ = std::move(transport);
  const double now = clock_.now();
  model_.begin(now);
  heard_ = now;
  has_stepped_ = false;
  ++status_.counts.connections;
  status_.problem = OpenProblem::None;
  status_.state = LinkState::Connected;
  // A device that was pushing for its previous user stops now, and one that waits for a first report answers.
  release();
}

/// One tick of an open device.
void DriverLoop::drive() noexcept {
  LinkCounts& counts = status_.counts;
  ++counts.ticks;
  if (!drain()) return lose(counts.read_errors);
  const double now = clock_.now();
  if (model_.period() > 0 && now - heard_ > settings_.silence) return lose(counts.silences);
  status_.sample = model_.sample(now);
  const double dt = has_stepped_ ? now - stepped_ : 0;
  has_stepped_ = true;
  stepped_ = now;
  haptics::SafeWrench safe = step_.step(status_.sample, now, dt);
  // By then the device's watchdog has ended the force: the wrench of an old pose would be a blow. The next step, whose
  // dt is as long, ends the force properly.
  if (clock_.now() - now > settings_.late) safe = {};
  if (!put(safe, now)) lose(counts.write_errors);
}

/// Waits for a report and reads all that have arrived: only the newest counts, and a queue is a delay that the hand
/// feels. False if the device is gone.
bool DriverLoop::drain() noexcept {
  LinkCounts& counts = status_.counts;
  unsigned reports = 0, reads = 0;
  double wait = settings_.read_timeout;
  for (; reads < settings_.most_reads; ++reads, wait = 0) {
    const int n = transport_->read(read_, wait);
    if (n < 0) return false;
    if (n == 0) break;
    const double now = clock_.now();
    const auto size = std::min(static_cast<std::size_t>(n), read_.size());
    const Taken taken = model_.take(std::span(read_).first(size), now);
    reports += taken.reports;
    counts.lost += taken.lost;
    counts.old += taken.old;
    counts.malformed += taken.malformed;
    // Invalid data is not a sign of life: a device that sends nothing else counts as gone.
    if (taken.reports > 0) heard_ = now;
  }
  counts.reports += reports;
  if (reports > 1) counts.superseded += reports - 1;
  if (reports == 0) ++counts.timeouts;
  return true;
}

/// False if the device is gone.
bool DriverLoop::put(const haptics::SafeWrench& safe, double now) noexcept {
  status_.wrench = safe.wrench();
  const std::size_t size = model_.push(safe, now, write_);
  if (size == 0) return true;
  ++status_.counts.writes;
  return transport_->write(std::span(write_).first(size));
}

/// If this fails, nothing more can be done: the device's watchdog does the rest.
void DriverLoop::release() noexcept {
  const std::size_t size = model_.release(clock_.now(), write_);
  if (size == 0) return;
  ++status_.counts.writes;
  transport_->write(std::span(write_).first(size));
}

void DriverLoop::lose(std::uint32_t& count) noexcept {
  ++count;
  release();
  transport_.reset();
  status_.wrench = {};
  status_.state = LinkState::Waiting;
  status_.retry = settings_.first_retry;
  next_attempt_ = clock_.now() + status_.retry;
}

/// One tick without a connection.
void DriverLoop::look() noexcept {
  const double now = clock_.now();
  if (status_.state == LinkState::Waiting) {
    if (now < next_attempt_) return clock_.wait(std::min(settings_.poll, next_attempt_ - now));
    ++status_.counts.attempts;
    connector_.begin();
    status_.state = LinkState::Connecting;
  }
  std::unique_ptr<Transport> transport;
  switch (connector_.poll(transport, status_.problem)) {
    case Connector::Answer::Opened:
      return open(std::move(transport));
    case Connector::Answer::Failed:
      status_.state = LinkState::Waiting;
      status_.retry = std::min(2 * status_.retry, settings_.longest_retry);
      next_attempt_ = now + status_.retry;
      return;
    case Connector::Answer::Pending:
      return clock_.wait(settings_.poll);
  }
}

}  // namespace riffler::pen
