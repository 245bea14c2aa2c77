// What the driver's thread does, without the thread: one call of tick() after the other, on any clock.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "haptics/safety.hpp"
#include "pen/hid/open_error.hpp"
#include "pen/hid_model.hpp"
#include "pen/published.hpp"

namespace riffler {

enum class LinkState : unsigned char {
  Stopped,     // the device was told not to push, and closed
  Connected,   // reports come
  Waiting,     // the device is gone; the next attempt comes after a while
  Connecting,  // somebody looks for it and opens it
};
const char* link_text(LinkState state) noexcept;

/// What happened since the start.
struct LinkCounts {
  std::uint64_t ticks = 0;       // of an open device
  std::uint64_t reports = 0;     // read and understood
  std::uint64_t superseded = 0;  // of them, those that a newer one had overtaken before a step saw them
  std::uint64_t lost = 0;        // that were sent, by their numbers, and never came
  std::uint64_t old = 0;         // that came again or too late
  std::uint64_t malformed = 0;   // pieces that are no report
  std::uint64_t timeouts = 0;    // ticks without a report
  std::uint64_t writes = 0;      // reports sent
  std::uint32_t read_errors = 0, write_errors = 0, silences = 0;  // each ended a connection
  std::uint32_t connections = 0, attempts = 0;
};

/// What other threads see. Trivially copyable.
struct LinkStatus {
  LinkState state = LinkState::Waiting;
  OpenProblem problem = OpenProblem::None;  // of the last attempt to connect
  PenSample sample{};                       // the newest; stays when the device is gone
  Wrench wrench{};                          // asked for by the last step; zero while there is no device
  LinkCounts counts{};
  double retry = 0;  // s from one attempt to the next
};

/// Called once in each tick of an open device; from the driver's thread, so it must not wait or allocate.
class PenStep {
 public:
  virtual ~PenStep() = default;
  /// The wrench to push with until the next step. `now` and `dt`, the time since the last step, are the driver's
  /// clock's; sample.time says how old the sample is. The first step after a connection, or with a device that had
  /// another step before, has dt = 0, and no other has.
  virtual SafeWrench step(const PenSample& sample, double now, double dt) noexcept = 0;
};

/// Finds and opens the device again, in another thread.
class Connector {
 public:
  virtual ~Connector() = default;
  /// Asks for one attempt.
  virtual void begin() noexcept = 0;
  enum class Answer : unsigned char { Pending, Failed, Opened };
  /// Of the attempt that was asked for. Opened hands the transport over; Failed says why.
  virtual Answer poll(std::unique_ptr<Transport>& transport, OpenProblem& problem) noexcept = 0;
};

struct DriverSettings {
  double read_timeout = 0.01;  ///< s without a report after which the step runs all the same, with an old sample
  double silence = 0.25;       ///< s without a report after which a device that has a period counts as gone
  double first_retry = 0.1;    ///< s after which a lost device is looked for; doubled after every failure …
  double longest_retry = 2;    ///< … up to this
  double poll = 0.01;          ///< s between two looks at the connector
  unsigned most_reads = 256;   ///< in one tick: a device that floods cannot hold up the step

  /// std::invalid_argument naming the field.
  void validate() const;
};

class DriverLoop {
 public:
  /// `transport` is open, and checked by the model; or null: the first attempt follows at once. References are kept.
  DriverLoop(HidModel& model, PenStep& step, Connector& connector, Clock& clock, std::unique_ptr<Transport> transport,
             const DriverSettings& settings = {});
  /// As stop().
  ~DriverLoop();
  DriverLoop(const DriverLoop&) = delete;
  DriverLoop& operator=(const DriverLoop&) = delete;

  /// Connected: waits for a report up to the time-out, takes all that are there, steps, and writes the wrench. On any
  /// error of reading or writing the device is told not to push, closed, and looked for again. Otherwise one look at
  /// the connector, and a wait. Allocates nothing, but for closing.
  void tick() noexcept;
  /// Tells the device not to push, and closes it. Ticks after this do nothing.
  void stop() noexcept;

  LinkStatus status() const noexcept { return published_.get(); }

 private:
  void open(std::unique_ptr<Transport> transport) noexcept;
  void drive() noexcept;
  bool drain() noexcept;
  bool put(const SafeWrench& safe, double now) noexcept;
  void release() noexcept;
  void lose(std::uint32_t& count) noexcept;
  void look() noexcept;
  void publish() noexcept { published_.set(status_); }

  HidModel& model_;
  PenStep& step_;
  Connector& connector_;
  Clock& clock_;
  DriverSettings settings_;
  std::unique_ptr<Transport> transport_;
  LinkStatus status_;
  Published<LinkStatus> published_;
  std::array<std::uint8_t, kLongestRead> buffer_{};
  double heard_ = 0, stepped_ = 0, next_attempt_ = 0;
  bool has_stepped_ = false;
};

}  // namespace riffler
