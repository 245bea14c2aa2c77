#include "pen/driver.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "base/real_time.hpp"
#include "base/without_signals.hpp"

namespace riffler::pen {
namespace {

using Seconds = std::chrono::duration<double>;

}  // namespace

/// State of both threads. Both hold a reference, so that it outlives a driver whose threads do not end in time.
struct Driver::Shared final : Connector, Clock {
  Shared(std::shared_ptr<PenModel> m, std::shared_ptr<PenStep> s, std::unique_ptr<Transport> transport, Open o,
         const DriverSettings& settings, std::shared_ptr<Clock> c)
      : model(std::move(m)),
        step(std::move(s)),
        open(std::move(o)),
        clock(std::move(c)),
        real_time(settings.real_time),
        loop(*model, *step, *this, *this, std::move(transport), settings) {}

  // Connector; called by the driver's thread while it has no device.
  void begin() noexcept override {
    const std::lock_guard lock(mutex);
    wanted = true;
    changed.notify_all();
  }

  Answer poll(std::unique_ptr<Transport>& transport, OpenProblem& problem) noexcept override {
    const std::lock_guard lock(mutex);
    if (!answer) return Answer::Pending;
    transport = std::move(found);
    problem = *std::exchange(answer, std::nullopt);
    return transport ? Answer::Opened : Answer::Failed;
  }

  // Clock
  double now() noexcept override { return clock ? clock->now() : steady_seconds(); }
  void wait(double seconds) noexcept override {
    if (clock) return clock->wait(seconds);
    std::unique_lock lock(mutex);
    changed.wait_for(lock, Seconds(seconds), [&] { return stopping.load() || answer.has_value(); });
  }

  void drive() {
    {
      std::optional<base::RealTimeScope> scope;
      if (real_time) scope.emplace(priority);
      while (!stopping.load()) loop.tick();
      loop.stop();
    }
    ended();
  }

  void connect() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [&] { return stopping.load() || wanted; });
      if (stopping.load()) break;
      wanted = false;
      lock.unlock();
      std::unique_ptr<Transport> transport;
      OpenProblem why = OpenProblem::None;
      std::string words;
      try {
        transport = open();
      } catch (const OpenError& error) {
        why = error.problem(), words = error.what();
      } catch (const std::exception& error) {
        why = OpenProblem::Other, words = error.what();
      }
      lock.lock();
      found = std::move(transport);
      text = std::move(words);
      answer = why;
      changed.notify_all();
    }
    lock.unlock();
    ended();
  }

  void ended() {
    const std::lock_guard lock(mutex);
    ++threads_ended;
    changed.notify_all();
  }

  const std::shared_ptr<PenModel> model;
  const std::shared_ptr<PenStep> step;
  const Open open;
  const std::shared_ptr<Clock> clock;
  const bool real_time;
  base::PriorityReport priority;
  std::atomic<bool> stopping{false};

  mutable std::mutex mutex;
  std::condition_variable changed;
  bool wanted = false;
  std::optional<OpenProblem> answer;
  std::unique_ptr<Transport> found;
  std::string text;
  int threads_ended = 0;

  DriverLoop loop;  // last, because it uses the other members
};

Driver::Driver(std::shared_ptr<PenModel> model, std::shared_ptr<PenStep> step, std::unique_ptr<Transport> transport,
               Open open, const DriverSettings& settings, std::shared_ptr<Clock> clock)
    : shared_(std::make_shared<Shared>(std::move(model), std::move(step), std::move(transport), std::move(open),
                                       settings, std::move(clock))) {
  // A signal would end a poll() of the threads with an error, which hidapi takes as a disconnect. base::OverrunGuard
  // lets its own through, which arrives only while the thread computes.
  const base::WithoutSignals masked;
  try {
    std::thread([s = shared_] { s->drive(); }).detach();
    std::thread([s = shared_] { s->connect(); }).detach();
  } catch (...) {
    shared_->stopping = true;
    throw;
  }
}

Driver::~Driver() {
  stop();
}

bool Driver::stop(double seconds) {
  if (!home_.here()) return false;
  std::unique_lock lock(shared_->mutex);
  shared_->stopping = true;
  shared_->changed.notify_all();
  return shared_->changed.wait_for(lock, Seconds(seconds), [&] { return shared_->threads_ended == 2; });
}

LinkStatus Driver::status() const noexcept {
  return shared_->loop.status();
}

std::string Driver::problem() const {
  if (!home_.here()) return "the device is driven by the process that this one was forked from";
  const std::lock_guard lock(shared_->mutex);
  return shared_->text;
}

base::ThreadPriority Driver::priority() const {
  return shared_->priority.get();
}

}  // namespace riffler::pen
