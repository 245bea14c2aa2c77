// Memory that two processes share, and words in it that one waits on and the other changes.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace riffler::base {

/// Shared memory without a name. It ends with the last process that holds it.
class SharedMemory {
 public:
  /// `bytes` of new memory, all zero. Throws std::system_error.
  explicit SharedMemory(std::size_t bytes);
  /// The memory behind a file descriptor that was handed to this process, which it now owns. Throws std::system_error,
  /// also if the memory has another size.
  SharedMemory(int file, std::size_t bytes);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  void* data() const noexcept { return data_; }
  int file() const noexcept { return file_; }

 private:
  void map();

  int file_;
  std::size_t bytes_;
  void* data_ = nullptr;
};

/// Waits until the word is not `seen` any more, at most `seconds`; may return early. The word lies in shared memory.
void wait_for_change(const std::atomic<std::uint32_t>& word, std::uint32_t seen, double seconds) noexcept;
/// Changes the word and wakes all threads that wait for it, in any process.
void change(std::atomic<std::uint32_t>& word) noexcept;

}  // namespace riffler::base
