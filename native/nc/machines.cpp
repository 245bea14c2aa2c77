#include "nc/machines.hpp"

#include "nc/description.hpp"
#include "nc/shipped_machines.hpp"

namespace riffler {

namespace {

DescriptionShelf shelf() {
  return {"machine", "RIFFLER_MACHINES", "machines", shipped_machines(), machine_summary};
}

}  // namespace

std::vector<DescriptionEntry> machines() {
  return list_descriptions(shelf());
}

std::unique_ptr<Machine> make_machine(std::string_view name, OptionReader& options) {
  const DescriptionText found = find_description(shelf(), name, options.owner());
  return std::make_unique<Machine>(describe_machine(found.toml, found.file, found.name, options));
}

}  // namespace riffler
