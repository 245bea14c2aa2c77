// NC code to Program: RS-274, APT cutter location files, Heidenhain Klartext and Sinumerik programs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "riffler/nc/program.hpp"
#include "riffler/nc/read/read_options.hpp"

namespace riffler::nc {

/// `options` without those of the reader: the options that the same machine takes elsewhere.
Options without_reading(Options options);

/// Reads a program from its text: one row per move end; all rows of a block have its line number. `file` (base name)
/// identifies the file in messages. Throws FormatError with number and text of the line for everything that is not
/// fully understood; docs/reading-nc.md lists what is. Poses are in the coordinates in which the first move is
/// programmed; later changes of offsets shift the moves after them. Throws Cancelled when the progress callback
/// cancels.
Program parse_nc(std::string_view text, const std::string& file, const ReadOptions& options = {});

/// As parse_nc, for a file. Throws FormatError if the file cannot be read.
Program read_nc(const std::filesystem::path& path, const ReadOptions& options = {});

class NcInterpreter;

/// Reads a file piece by piece, with memory independent of its size.
class NcStream {
 public:
  /// Opens the file; `rows`: largest number of rows per piece. Throws FormatError if the file cannot be opened,
  /// std::invalid_argument for invalid options and for `rows` < 2.
  NcStream(const std::filesystem::path& path, const ReadOptions& options = {}, std::size_t rows = 65536);
  NcStream(NcStream&&) noexcept;
  ~NcStream();

  /// Reads up to `rows` rows into `program`. The first row repeats the last one of the previous piece. Returns false
  /// with an empty program at the end and after a FormatError.
  bool next(Program& program);

 private:
  void fill(Program& program);

  std::unique_ptr<NcInterpreter> interpreter_;
  std::size_t rows_, taken_ = 0;
  Program whole_;  // all rows, for a language that can only be read as a whole
  std::unique_ptr<Move> last_;
};

}  // namespace riffler::nc
