// Another program that this process starts and ends.
#pragma once

#include <string>
#include <vector>

#include "base/own_thread.hpp"

namespace riffler::base {

/// A running program. On Windows none can be started yet: the constructor throws. It has the file descriptor `given` as
/// its number 3, nothing else of ours but standard output and error, its own process group (so Ctrl C in a terminal
/// does not reach it), and default signals.
class ChildProcess {
 public:
  static constexpr int kGiven = 3;

  /// Starts the file, which needs no permission to execute: files out of a zip may have lost it. `words`: its arguments
  /// without its name. Throws std::system_error with the file's name.
  ChildProcess(const std::string& file, const std::vector<std::string>& words, int given);
  /// Kills the program if it runs. A forked process leaves it alone.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  bool ended() noexcept;
  /// Waits for its end, at most `seconds`. Returns whether it has ended.
  bool wait(double seconds) noexcept;
  /// How it ended, such as "it ended with code 3" or "it crashed (Segmentation fault)".
  std::string end_text() const;
  int id() const noexcept { return id_; }

 private:
  int id_ = -1;
  bool ended_ = false;
  int status_ = 0;
  HomeProcess home_;
};

}  // namespace riffler::base
