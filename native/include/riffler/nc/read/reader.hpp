// NC code (RS-274, an APT cutter location file, a Heidenhain conversational program, a Sinumerik program) → Program.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "riffler/nc/program.hpp"
#include "riffler/nc/read/read_options.hpp"

namespace riffler::nc {

/// `options` without those of the reader alone: what the same machine takes for other work.
Options without_reading(Options options);

/// One row per move end; rows of one block have its line. `file` (base name) stands in messages. FormatError naming the
/// line, with its text, for everything that is not understood in full; docs/reading-nc.md says what is. Poses are in
/// the coordinates in which the first move is programmed; offsets that change later move what comes after. Cancelled
/// where the progress callback says so.
Program parse_nc(std::string_view text, const std::string& file, const ReadOptions& options = {});

Program read_nc(const std::filesystem::path& path, const ReadOptions& options = {});

class NcInterpreter;

/// A file that is read as it is asked for, in memory that does not grow with it.
class NcStream {
 public:
  /// FormatError where the file cannot be opened, std::invalid_argument for options and `rows` < 2.
  NcStream(const std::filesystem::path& path, const ReadOptions& options = {}, std::size_t rows = 65536);
  NcStream(NcStream&&) noexcept;
  ~NcStream();

  /// The next at most `rows` rows; the first of them is the last of those before, where there are any. False, and an
  /// empty program, at the end and after a FormatError.
  bool next(Program& program);

 private:
  void fill(Program& program);

  std::unique_ptr<NcInterpreter> interpreter_;
  std::size_t rows_, taken_ = 0;
  Program whole_;  // the rows of a language that is read as a whole
  std::unique_ptr<Move> last_;
};

}  // namespace riffler::nc
