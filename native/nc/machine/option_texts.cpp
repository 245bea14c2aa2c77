#include "nc/machine/option_texts.hpp"

#include <algorithm>
#include <stdexcept>

#include "nc/machine/machines.hpp"
#include "nc/machine/post_options.hpp"

namespace riffler::nc {

namespace {

struct Text {
  std::string_view name, unit, about;
  std::string_view languages = {};  ///< languages whose posts use it; empty: all
};

/// Options without a description in the machine's own file. A name that ends in _ stands for one option per axis.
constexpr Text kTexts[] = {
    {"tcp", "",
     "X Y Z are the tip in part coordinates, and the control knows the machine; otherwise the positions of its linear "
     "axes"},
    {"direction", "", "rotation of the tables for positive angles: iso, left-handed; linuxcnc, right-handed"},
    {"max_rotary", "deg/min", "largest speed of a rotary axis in feed moves"},
    {"limits_", "mm", "the lowest and the highest position of the axis"},
    {"rate_", "mm/min", "the highest speed of the axis"},
    {"tool_length", "", "the code that activates tool length compensation"},
    {"feed", "", "how feeds are written where a rotary axis moves: inverse-time (G93), or per-minute (G94)"},
    {"rapids", "", "how rapids move: straight, or each axis at its own rate until it arrives"},
    {"line_numbers", "", "step of the N words; 0: no line numbers"},
    {"coolant", "", "what is switched on before the first cut"},
    {"vectors", "", "Heidenhain: LN blocks with the tool axis instead of the rotary axes", "heidenhain"},
    {"retract", "mm",
     "machine Z of G53 or SUPA to which the tool retracts at the start and the end, instead of the machine's own "
     "retract",
     "rs274 sinumerik"},
    {"safe_start", "",
     "each tool begins with a retract, then the rotary axes, then X and Y, then Z; otherwise the first block moves "
     "straight from the machine's current position"},
    {"safe_height", "mm", "z in part coordinates at which the tool is above everything: rotary axes unwind there"},
    {"arcs", "", "replace line segments by G2 and G3 where the tolerance allows"},
};

const Text* text_of(std::string_view name) {
  const auto is = [&](const Text& t) {
    return t.name == name || (t.name.ends_with('_') && name.size() == t.name.size() + 1 && name.starts_with(t.name));
  };
  const auto* found = std::ranges::find_if(kTexts, is);
  return found == std::end(kTexts) ? nullptr : found;
}

MachineOption described(OptionFact fact) {
  const Text* text = text_of(fact.name);
  if (!text) return {std::move(fact), "mm", true};  // a machine's own options are places and lengths
  std::string unit(text->unit);
  // One option per axis; rotary axes use degrees.
  if (text->name.ends_with('_') && fact.name.back() <= 'c') unit.replace(0, 2, "deg");
  fact.about = text->about;
  return {std::move(fact), std::move(unit)};
}

}  // namespace

std::vector<MachineOption> machine_options(std::string_view name, Options options) {
  OptionReader listing(std::move(options), "machine " + std::string(name), true);
  const std::unique_ptr<Machine> machine = make_machine(name, listing);
  take_post_options(listing, machine->control().coolant);
  listing.done();
  std::vector<MachineOption> out;
  for (const OptionFact& fact : listing.facts()) {
    const Text* text = text_of(fact.name);
    if (text && !text->languages.empty() && text->languages.find(machine->control().language) == text->languages.npos)
      continue;
    out.push_back(described(fact));
  }
  std::ranges::stable_partition(out, &MachineOption::own);
  return out;
}

}  // namespace riffler::nc
