// A message bus with rtkit on a socket: grants, refuses, answers nonsense, or never answers.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

namespace riffler::test {

class FakeRtkit {
 public:
  enum class Does {
    Grants,          // as rtkit does: it makes the thread SCHED_RR itself
    Refuses,         // with an error
    IsNotInstalled,  // the bus knows no such service
    OnlyAgrees,      // but leaves the priority unchanged
    SaysNonsense,    // bytes that are no message
    NamesNoNumber,   // properties of another type
    NamesHugeLevel,  // beyond any that there is
    IsSilent,        // from the first call of rtkit on
    NeverLogsIn,     // says nothing at all
    RejectsLogIn,
    HangsUp,
  };

  explicit FakeRtkit(Does does, int level = 20, std::int64_t microseconds = 200'000);
  ~FakeRtkit();
  FakeRtkit(const FakeRtkit&) = delete;
  FakeRtkit& operator=(const FakeRtkit&) = delete;

  /// "unix:abstract=…"
  std::string address() const;
  /// Calls of MakeThreadRealtime so far, and the level of the last one.
  int asked() const { return asked_; }
  int level() const { return level_; }

 private:
  void serve();
  bool log_in(int fd);
  bool answer(int fd, const std::vector<std::uint8_t>& call);
  bool send(int fd, const std::vector<std::uint8_t>& bytes);

  Does does_;
  int most_;
  std::int64_t microseconds_;
  std::string name_;
  int listener_ = -1;
  std::atomic<int> asked_{0}, level_{0}, connection_{-1};
  std::atomic<bool> ending_{false};
  std::thread server_;
};

}  // namespace riffler::test
