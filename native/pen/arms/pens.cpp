#include "pen/arms/pens.hpp"

#include <filesystem>
#include <system_error>

#include "pen/arms/description.hpp"
#include "pen/arms/shipped_pens.hpp"

namespace riffler::pen {

namespace {

base::DescriptionCatalog shelf() {
  return {"pen", "RIFFLER_PENS", "pens", shipped_pens(), pen_summary};
}

base::DescriptionText find_pen(std::string_view name) {
  return find_description(shelf(), name, "pen '" + std::string(name) + "'");
}

}  // namespace

std::vector<base::DescriptionEntry> pens() {
  return list_descriptions(shelf());
}

PenGeometry load_pen(std::string_view name) {
  const base::DescriptionText found = find_pen(name);
  return describe_pen(found.toml, found.file, found.name);
}

bool is_own_pen(std::string_view name) {
  for (const std::filesystem::path& folder : own_folders(shelf())) {
    std::error_code none;
    if (std::filesystem::is_regular_file(folder / (std::string(name) + ".toml"), none)) return true;
  }
  return false;
}

std::string pen_text(std::string_view name) {
  return find_pen(name).toml;
}

}  // namespace riffler::pen
