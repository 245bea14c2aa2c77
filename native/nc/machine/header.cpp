#include "nc/machine/header.hpp"

#include <algorithm>
#include <stdexcept>

#include "nc/machine/machines.hpp"

namespace riffler::nc {

namespace {

constexpr std::string_view kBegin = "Riffler ", kPost = ", post ";

/// The text of a comment line, in brackets or, after a block number, behind a semicolon.
std::string_view comment_of(std::string_view line) {
  if (line.starts_with('(') && line.ends_with(')')) return line.substr(1, line.size() - 2);
  line.remove_prefix(std::min(line.find_first_not_of("0123456789 "), line.size()));
  return line.starts_with("; ") ? line.substr(2) : std::string_view();
}

/// Whether `name` is a machine whose words mean the same to any machine with tip coordinates.
bool is_upright(const std::string& name) {
  try {
    OptionReader none({}, name);
    const auto machine = make_machine(name, none);
    return machine->axes() == "XYZ" && !machine->joint_words();
  } catch (const std::exception&) {
    return false;
  }
}

void check_name(const NcPlace& place, const Machine& machine) {
  const std::string_view comment = comment_of(place.text);
  const std::size_t at = comment.rfind(kPost);
  if (at == comment.npos) return;
  const std::string name(comment.substr(at + kPost.size()));
  if (name == machine.name() || (!machine.joint_words() && is_upright(name))) return;
  place.fail("written for machine " + name + ", not " + machine.name() + ": read it with machine " + name +
             ", or with options {'header': 'ignore'}");
}

void check_words(const NcPlace& place, const Machine& machine) {
  const std::string_view comment = comment_of(place.text);
  const bool joints = comment.starts_with("X Y Z: joints"), tip = comment.starts_with("X Y Z: tip");
  if (!(machine.joint_words() ? tip : joints)) return;
  place.fail(std::string("X Y Z are ") + (tip ? "the tip's place" : "where the axes stand") +
             " here: read it with options {'tcp': " + (tip ? "True}" : "False}"));
}

}  // namespace

std::string header_line(const Machine& machine) {
  return "Riffler " RIFFLER_VERSION ", post " + machine.name();
}

void check_header(NcSource& source, const Machine& machine) {
  const NcSource::Mark start = source.mark();
  std::string_view line;
  bool more = source.next(line);
  if (more && line.ends_with("BEGIN PGM RIFFLER MM")) more = source.next(line);
  if (more && comment_of(line).starts_with(kBegin)) {
    check_name({source.name(), source.line(), line}, machine);
    if (source.next(line)) check_words({source.name(), source.line(), line}, machine);
  }
  source.go(start);
}

}  // namespace riffler::nc
