#include "base/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <system_error>
#include <thread>

namespace riffler::base {
namespace {

constexpr int kFree = 10;  // file descriptors from here on are not those that the program gets

/// A file descriptor that closes itself.
class OpenFile {
 public:
  explicit OpenFile(int file) : file_(file) {}
  ~OpenFile() {
    if (file_ >= 0) ::close(file_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  operator int() const { return file_; }

 private:
  int file_;
};

int copied(int from, off_t bytes) {
  const OpenFile memory(::memfd_create("riffler-program", MFD_CLOEXEC));
  if (memory < 0) return -1;
  for (off_t done = 0; done < bytes;)
    if (::sendfile(memory, from, &done, static_cast<std::size_t>(bytes - done)) <= 0) return -1;
  return ::fcntl(memory, F_DUPFD_CLOEXEC, kFree);
}

/// A path by which the file can be executed; `copy` holds what it leads to, or −1.
std::string executable(const std::string& file, int& copy) {
  copy = -1;
  if (::access(file.c_str(), X_OK) == 0) return file;
  const OpenFile source(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status{};
  if (source >= 0 && ::fstat(source, &status) == 0) copy = copied(source, status.st_size);
  if (copy < 0) throw std::system_error(errno, std::generic_category(), file);
  return "/proc/self/fd/" + std::to_string(copy);
}

class SpawnActions {
 public:
  explicit SpawnActions(int given) {
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&files, given, ChildProcess::kGiven);
    ::posix_spawnattr_init(&attributes);
    sigset_t all, none;
    ::sigfillset(&all), ::sigemptyset(&none);
    ::posix_spawnattr_setsigdefault(&attributes, &all);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setpgroup(&attributes, 0);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnActions() {
    ::posix_spawn_file_actions_destroy(&files);
    ::posix_spawnattr_destroy(&attributes);
  }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;

  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
};

}  // namespace

ChildProcess::ChildProcess(const std::string& file, const std::vector<std::string>& words, int given) {
  int copy = -1;
  const std::string path = executable(file, copy);
  const OpenFile kept(copy);
  std::string name = file;
  std::vector<std::string> rest = words;
  std::vector<char*> arguments{name.data()};
  for (std::string& word : rest) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const SpawnActions actions(given);
  const int error = ::posix_spawn(&id_, path.c_str(), &actions.files, &actions.attributes, arguments.data(), environ);
  if (error != 0) throw std::system_error(error, std::generic_category(), file);
}

ChildProcess::~ChildProcess() {
  if (!home_.here() || ended()) return;
  ::kill(id_, SIGKILL);
  wait(1);
}

bool ChildProcess::ended() noexcept {
  if (ended_) return true;
  pid_t found = 0;
  do found = ::waitpid(id_, &status_, WNOHANG);
  while (found < 0 && errno == EINTR);
  // Where the process ignores the ends of its children, how this one ended is unknown.
  ended_ = found != 0;
  return ended_;
}

bool ChildProcess::wait(double seconds) noexcept {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!ended() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return ended_;
}

std::string ChildProcess::end_text() const {
  if (WIFSIGNALED(status_)) return std::string("it crashed (") + ::strsignal(WTERMSIG(status_)) + ")";
  return "it ended with code " + std::to_string(WEXITSTATUS(status_));
}

}  // namespace riffler::base
