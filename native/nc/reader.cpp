#include "nc/reader.hpp"

#include <algorithm>
#include <stdexcept>

#include "geom/error.hpp"
#include "geom/io.hpp"
#include "nc/apt_reader.hpp"
#include "nc/heidenhain_reader.hpp"
#include "nc/heidenhain_text.hpp"
#include "nc/interpreter.hpp"
#include "nc/limits.hpp"
#include "nc/machines.hpp"

namespace riffler {

namespace {

/// Of the machine's control.
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
/// FormatError where the text is in another language than the machine's control reads.
void check_language(NcSource& source, const std::string& language) {
  const bool conversational = begins_heidenhain(source);
  if (conversational == (language == "heidenhain")) return;
  const std::string other = conversational ? "heidenhain" : "rs274";
  const std::string what = conversational
                               ? "a Heidenhain conversational program (BEGIN PGM), and the machine's control "
                                 "reads another language"
                               : "not a Heidenhain conversational program, which the machine's control reads: "
                                 "BEGIN PGM is not in its first block";
  throw FormatError(source.name(), "line 1",
                    what + "; machines that read " + other + ": " + machines_of_language(other));
}

/// A file of a language that is read as a whole.
Program parse_whole(std::string_view text, const std::string& file, const ReadOptions& options,
                    const std::string& language) {
  NcSource source(text, file);
  check_language(source, language);
  return language == "apt" ? parse_apt(text, file, options) : parse_heidenhain(text, file, options);
}

Program read_whole(const std::filesystem::path& path, const ReadOptions& options, const std::string& language) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  return parse_whole({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.filename().string(), options,
                     language);
}

std::unique_ptr<NcSource> checked_source(std::unique_ptr<NcSource> source) {
  check_language(*source, "rs274");
  return source;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

Program read_all(NcInterpreter& interpreter) {
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

}  // namespace

Options without_reading(Options options) {
  for (const char* name : kOfReading) options.erase(name);
  return options;
}

Program parse_nc(std::string_view text, const std::string& file, const ReadOptions& options) {
  if (const std::string language = language_of(options); language != "rs274")
    return parse_whole(text, file, options, language);
  NcInterpreter interpreter(checked_source(std::make_unique<NcSource>(text, file)), {}, options);
  return read_all(interpreter);
}

Program read_nc(const std::filesystem::path& path, const ReadOptions& options) {
  if (const std::string language = language_of(options); language != "rs274")
    return read_whole(path, options, language);
  NcInterpreter interpreter(checked_source(std::make_unique<NcSource>(path)), folder_of(path), options);
  return read_all(interpreter);
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
    // What follows an error has no meaning.
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

}  // namespace riffler
