#include "base/background.hpp"

#include <algorithm>
#include <utility>

namespace riffler::base {

Background::Background(Work work) : thread_([this, w = std::move(work)]() mutable { run(std::move(w)); }) {}

Background::~Background() {
  cancel();
  thread_.join();
}

void Background::run(Work work) {
  // Only this thread writes the share. A part of the work may report 1, and so may work that fails afterwards.
  const auto listen = [this](double share) {
    constexpr double kNearlyAll = 1 - 1e-9;
    share_.store(std::max(share_.load(std::memory_order_relaxed), std::min(share, kNearlyAll)),
                 std::memory_order_relaxed);
    return !cancelled_.load(std::memory_order_relaxed);
  };
  try {
    work(listen);
    share_.store(1, std::memory_order_relaxed);
  } catch (...) {
    error_ = std::current_exception();
  }
  work = nullptr;
  const std::lock_guard lock(mutex_);
  done_.store(true, std::memory_order_release);
  ended_->notify_all();
}

bool Background::wait(std::chrono::milliseconds most) const {
  if (!home_.here()) return true;
  std::unique_lock lock(mutex_);
  return ended_->wait_for(lock, most, [this] { return done(); });
}

void Background::wait() const {
  if (!home_.here()) return;
  std::unique_lock lock(mutex_);
  ended_->wait(lock, [this] { return done(); });
}

void Background::check() const {
  if (!done_.load(std::memory_order_acquire)) home_.check("the call");
  if (error_) std::rethrow_exception(error_);
}

}  // namespace riffler::base
