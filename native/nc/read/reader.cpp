#include "riffler/nc/read/reader.hpp"

#include <algorithm>
#include <stdexcept>

#include "base/io.hpp"
#include "base/path_text.hpp"
#include "nc/limits.hpp"
#include "nc/machine/machines.hpp"
#include "nc/read/apt_reader.hpp"
#include "nc/read/heidenhain_reader.hpp"
#include "nc/read/heidenhain_text.hpp"
#include "nc/read/interpreter.hpp"
#include "nc/read/sinumerik_reader.hpp"
#include "nc/read/sinumerik_text.hpp"
#include "riffler/base/error.hpp"

namespace riffler::nc {

namespace {

/// The language of the machine's control.
std::string language_of(const ReadOptions& options) {
  OptionReader taken(options.options, "machine " + options.machine);
  return make_machine(options.machine, taken)->control().language;
}

constexpr const char* kOfReading[] = {"chord_tolerance",
                                      "axis_tolerance",
                                      "block_delete",
                                      "header",
                                      "unknown",
                                      "subroutines",
                                      "parameters",
                                      "max_turns",
                                      "cutter_compensation",
                                      "tool_diameters",
                                      "units",
                                      "arc_tolerance",
                                      "arc_centres",
                                      "first_feed",
                                      "first_motion",
                                      "g54",
                                      "g55",
                                      "g56",
                                      "g57",
                                      "g58",
                                      "g59",
                                      "g59_1",
                                      "g59_2",
                                      "g59_3",
                                      "g28",
                                      "g30"};
/// Throws FormatError if the text is in another language than the machine's control reads. RS-274 may follow the header
/// of a Sinumerik program, as on controls that read both.
void check_language(NcSource& source, const std::string& language) {
  const bool conversational = begins_heidenhain(source);
  const bool sinumerik = language != "sinumerik" && language != "rs274" && begins_sinumerik(source);
  if (conversational == (language == "heidenhain") && !sinumerik) return;
  const std::string other = conversational ? "heidenhain" : sinumerik ? "sinumerik" : "rs274";
  std::string what =
      "not a Heidenhain conversational program, which the machine's control reads: BEGIN PGM is not in "
      "its first block";
  if (conversational)
    what = "a Heidenhain conversational program (BEGIN PGM), and the machine's control reads another language";
  else if (sinumerik)
    what = "a Sinumerik program (%_N_ or ;$PATH= at its beginning), and the machine's control reads another language";
  throw FormatError(source.name(), "line 1",
                    what + "; machines that read " + other + ": " + machines_of_language(other));
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

/// Reads a file in a language that is read as a whole. `folder`: of its subprograms; empty: none.
Program parse_whole(std::string_view text, const std::string& file, const ReadOptions& options,
                    const std::string& language, const std::filesystem::path& folder) {
  NcSource source(text, file);
  check_language(source, language);
  if (language == "sinumerik") return parse_sinumerik(text, file, options, folder);
  if (language == "apt") return parse_apt(text, file, options);
  if (language == "heidenhain") return parse_heidenhain(text, file, options);
  throw FormatError(file, "line 1", "programs in the language " + language + " are written, and cannot be read");
}

Program read_whole(const std::filesystem::path& path, const ReadOptions& options, const std::string& language) {
  const std::vector<std::uint8_t> bytes = base::read_file(path);
  return parse_whole({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, base::file_name(path), options,
                     language, folder_of(path));
}

std::unique_ptr<NcSource> checked_source(std::unique_ptr<NcSource> source) {
  check_language(*source, "rs274");
  return source;
}

Program read_rows(NcInterpreter& interpreter) {
  Program program;
  std::vector<Move>& pending = interpreter.pending();
  bool more = true;
  while (more) {
    more = interpreter.step();
    if (program.size() + pending.size() > kMaxRows) interpreter.fail_rows();
    for (const Move& move : pending) program.append(move);
    pending.clear();
  }
  program.provenance = interpreter.provenance(), program.notes = interpreter.notes();
  return program;
}

/// For a Sinumerik program, errors name the machines that read it.
Program read_all(std::unique_ptr<NcSource> source, const std::filesystem::path& folder, const ReadOptions& options) {
  const bool sinumerik = begins_sinumerik(*source);
  try {
    NcInterpreter interpreter(checked_source(std::move(source)), folder, options);
    return read_rows(interpreter);
  } catch (const FormatError& error) {
    if (!sinumerik) throw;
    throw FormatError(
        error.what(), "",
        "the file begins as a Sinumerik program; machines that read them: " + machines_of_language("sinumerik"));
  }
}

}  // namespace

Options without_reading(Options options) {
  for (const char* name : kOfReading) options.erase(name);
  return options;
}

Program parse_nc(std::string_view text, const std::string& file, const ReadOptions& options) {
  if (const std::string language = language_of(options); language != "rs274")
    return parse_whole(text, file, options, language, {});
  return read_all(std::make_unique<NcSource>(text, file), {}, options);
}

Program read_nc(const std::filesystem::path& path, const ReadOptions& options) {
  if (const std::string language = language_of(options); language != "rs274")
    return read_whole(path, options, language);
  return read_all(std::make_unique<NcSource>(path), folder_of(path), options);
}

NcStream::NcStream(const std::filesystem::path& path, const ReadOptions& options, std::size_t rows) : rows_(rows) {
  if (rows < 2) throw std::invalid_argument("rows must be at least 2");
  if (const std::string language = language_of(options); language != "rs274")
    whole_ = read_whole(path, options, language);
  else
    interpreter_ =
        std::make_unique<NcInterpreter>(checked_source(std::make_unique<NcSource>(path)), folder_of(path), options);
}

NcStream::NcStream(NcStream&&) noexcept = default;
NcStream::~NcStream() = default;

bool NcStream::next(Program& program) {
  program = Program();
  try {
    fill(program);
  } catch (...) {
    // Nothing after an error has a meaning.
    interpreter_.reset(), whole_ = Program();
    throw;
  }
  if (program.empty()) return false;
  last_ = std::make_unique<Move>(program[program.size() - 1]);
  return true;
}

void NcStream::fill(Program& program) {
  std::size_t fresh = 0;
  const auto append = [&](const Move& move) {
    if (fresh++ == 0 && last_) program.append(*last_);
    program.append(move);
  };
  if (!interpreter_) {
    while (taken_ < whole_.size() && program.size() < rows_) append(whole_[taken_++]);
    program.provenance = whole_.provenance, program.notes = whole_.notes, program.tools = whole_.tools;
    return;
  }
  std::vector<Move>& pending = interpreter_->pending();
  bool more = true;
  while (more && program.size() < rows_) {
    if (taken_ == pending.size()) {
      pending.clear(), taken_ = 0;
      more = interpreter_->step();
    }
    while (taken_ < pending.size() && program.size() < rows_) append(pending[taken_++]);
  }
  program.provenance = interpreter_->provenance(), program.notes = interpreter_->notes();
}

}  // namespace riffler::nc
