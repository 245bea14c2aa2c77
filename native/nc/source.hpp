// Text of NC code, line by line, from memory or from a file larger than memory; control flow can jump within it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_stream.hpp"

namespace riffler::nc {

/// The reader's position, for messages.
struct NcPlace {
  std::string file;       ///< base name
  int line = 0;           ///< 1-based
  std::string_view text;  ///< text of the block

  /// Throws FormatError with file, line, `what` and the block's text (its first 80 characters).
  [[noreturn]] void fail(const std::string& what) const;
};

class NcSource {
 public:
  /// A line to which go() returns.
  struct Mark {
    std::uint64_t offset = 0;
    int line = 0;  ///< number of the line before it
  };

  /// Keeps a reference to `text`, which must outlive this object.
  NcSource(std::string_view text, std::string name)
      : name_(std::move(name)), window_(text), size_(static_cast<double>(text.size())) {}
  /// Reads the file in windows of `window` bytes, which no line may exceed. Throws FormatError if it cannot be opened.
  explicit NcSource(const std::filesystem::path& path, std::size_t window = 1 << 18);

  /// The next line without its end (LF or CR LF), valid until the next call; false at the end.
  bool next(std::string_view& line);
  /// 1-based number of the last line from next().
  int line() const { return line_; }
  Mark mark() const { return {base_ + at_, line_}; }
  void go(const Mark& mark);

  const std::string& name() const { return name_; }
  /// Fraction of the text read so far, 0 to 1.
  double share() const { return size_ > 0 ? std::min(1.0, static_cast<double>(base_ + at_) / size_) : 1; }

 private:
  bool more();

  std::string name_;
  base::InputStream file_;
  std::vector<char> buffer_;
  std::string_view window_;
  std::uint64_t base_ = 0;  // offset of the window in the text
  std::size_t at_ = 0;      // offset in the window
  int line_ = 0;
  double size_ = 0;  // size of the text, bytes
};

}  // namespace riffler::nc
