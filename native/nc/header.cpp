#include "nc/header.hpp"

#include <stdexcept>

#include "nc/machines.hpp"

namespace riffler {

namespace {

constexpr std::string_view kBegin = "(Riffler ", kPost = ", post ";

/// Whether `name` is a machine that we know whose words any tip-centred machine takes alike.
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
  const std::size_t at = place.text.rfind(kPost);
  if (at == place.text.npos || !place.text.ends_with(')')) return;
  const std::string name(place.text.substr(at + kPost.size(), place.text.size() - at - kPost.size() - 1));
  if (name == machine.name() || (!machine.joint_words() && is_upright(name))) return;
  place.fail("written for machine " + name + ", not " + machine.name() + ": read it with machine " + name +
             ", or with options {'header': 'ignore'}");
}

void check_words(const NcPlace& place, const Machine& machine) {
  const bool joints = place.text.starts_with("(X Y Z: joints"), tip = place.text.starts_with("(X Y Z: tip");
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
  if (source.next(line) && line.starts_with(kBegin)) {
    check_name({source.name(), source.line(), line}, machine);
    if (source.next(line)) check_words({source.name(), source.line(), line}, machine);
  }
  source.go(start);
}

}  // namespace riffler
