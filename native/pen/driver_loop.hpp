// The work of the driver's thread without the thread: successive calls of tick(), on any clock.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "pen/link/transport.hpp"
#include "pen/pen_model.hpp"
#include "riffler/haptics/safety.hpp"
#include "riffler/pen/driver_settings.hpp"
#include "riffler/pen/hid/open_error.hpp"
#include "riffler/pen/link_status.hpp"
#include "riffler/pen/pen_step.hpp"
#include "riffler/pen/published.hpp"

namespace riffler::pen {

/// Finds and opens the device again, in another thread.
class Connector {
 public:
  virtual ~Connector() = default;
  /// Starts one attempt.
  virtual void begin() noexcept = 0;
  enum class Answer : unsigned char { Pending, Failed, Opened };
  /// The result of the attempt. Opened passes the transport; Failed gives the reason.
  virtual Answer poll(std::unique_ptr<Transport>& transport, OpenProblem& problem) noexcept = 0;
};

class DriverLoop {
 public:
  /// `transport`: open and checked; or null: the first attempt follows at once. Keeps references.
  DriverLoop(PenModel& model, PenStep& step, Connector& connector, Clock& clock, std::unique_ptr<Transport> transport,
             const DriverSettings& settings = {});
  /// As stop().
  ~DriverLoop();
  DriverLoop(const DriverLoop&) = delete;
  DriverLoop& operator=(const DriverLoop&) = delete;

  /// Connected: waits for a report up to the time-out, reads all available ones, runs the step and writes the wrench.
  /// On a read or write error the device is released, closed and reconnected. Not connected: polls the connector once
  /// and waits. Allocates nothing, except when closing.
  void tick() noexcept;
  /// Makes the device stop pushing and closes it. Later ticks do nothing.
  void stop() noexcept;

  LinkStatus status() const noexcept { return published_.get(); }

 private:
  void open(std::unique_ptr<Transport> transport) noexcept;
  void drive() noexcept;
  bool drain() noexcept;
  bool put(const haptics::SafeWrench& safe, double now) noexcept;
  void release() noexcept;
  void lose(std::uint32_t& count) noexcept;
  void look() noexcept;
  void publish() noexcept { published_.set(status_); }

  PenModel& model_;
  PenStep& step_;
  Connector& connector_;
  Clock& clock_;
  DriverSettings settings_;
  std::unique_ptr<Transport> transport_;
  LinkStatus status_;
  Published<LinkStatus> published_;
  std::vector<std::uint8_t> read_, write_;  // the longest messages
  double heard_ = 0, stepped_ = 0, next_attempt_ = 0;
  bool has_stepped_ = false;
};

}  // namespace riffler::pen
