#include "nc/machine/machines.hpp"

#include <stdexcept>

#include "nc/machine/shipped_machines.hpp"

namespace riffler::nc {

namespace {

base::DescriptionCatalog shelf() {
  return {"machine", "RIFFLER_MACHINES", "machines", shipped_machines(), machine_summary};
}

}  // namespace

std::vector<base::DescriptionEntry> machines() {
  return list_descriptions(shelf());
}

std::string machines_with(char axis, std::string_view language) {
  std::string out;
  for (const base::DescriptionEntry& entry : machines()) {
    OptionReader options({{"tcp", true}}, entry.name);  // tip coordinates need no pivot
    try {
      const std::unique_ptr<Machine> machine = make_machine(entry.name, options);
      if (machine->control().language != language || machine->axes().find(axis) == std::string_view::npos) continue;
      out += (out.empty() ? "" : ", ") + entry.name;
    } catch (const std::invalid_argument&) {
      continue;  // an unreadable user file: reported when it is used
    }
  }
  return out;
}

std::unique_ptr<Machine> make_machine(std::string_view name, OptionReader& options) {
  const base::DescriptionText found = find_description(shelf(), name, options.owner());
  return std::make_unique<Machine>(describe_machine(found.toml, found.file, found.name, options));
}

MachineTexts texts_of_machine(std::string_view name) {
  const base::DescriptionText found = find_description(shelf(), name, "machine " + std::string(name));
  return machine_texts(found.toml, found.file);
}

std::string machines_of_language(std::string_view language) {
  std::string out;
  for (const base::DescriptionEntry& entry : machines()) {
    try {
      OptionReader none({{"tcp", true}}, entry.name);
      if (make_machine(entry.name, none)->control().language == language) out += (out.empty() ? "" : ", ") + entry.name;
    } catch (const std::exception&) {
      // Skips descriptions that cannot be read or that require options.
    }
  }
  return out;
}

}  // namespace riffler::nc
