#include "base/toml.hpp"

#include <algorithm>
#include <cmath>

#include "riffler/base/error.hpp"

namespace riffler::base {

namespace {

/// The number of the first line whose key does not start with a valid character.
int line_without_key(std::string_view text) {
  int line = 1;
  for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n', end + 1), ++line) {
    try {
      static_cast<void>(toml::parse(text.substr(0, end)));
    } catch (const NoTomlKey&) {
      break;
    } catch (const toml::parse_error&) {
    }
  }
  return line;
}

}  // namespace

toml::table TomlReader::parse(std::string_view text) const {
  check_ascii(text);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& e) {
    throw FormatError(file_, "line " + std::to_string(e.source().begin.line), std::string(e.description()));
  } catch (const NoTomlKey&) {
    throw FormatError(file_, "line " + std::to_string(line_without_key(text)), "a key is expected");
  }
}

/// Outside comments and strings TOML is ASCII; toml++ 3.3 has undefined behaviour for some other input.
void TomlReader::check_ascii(std::string_view text) const {
  char quote = 0;
  bool comment = false;
  int line = 1;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '\n') comment = false, ++line;
    if (comment) continue;
    if (quote != 0) {
      if (c == '\\' && quote == '"') ++k;
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      comment = true;
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      throw FormatError(file_, "line " + std::to_string(line), "a character outside ASCII");
    }
  }
}

void TomlReader::fail(const toml::node& at, const std::string& what) const {
  // The root of a text without tables has no source position.
  throw FormatError(file_, "line " + std::to_string(std::max<std::uint32_t>(at.source().begin.line, 1)), what);
}

void TomlReader::allow(const toml::table& table, std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, node] : table)
    if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
      fail(node, "unknown key " + std::string(key.str()));
}

const toml::node& TomlReader::needed(const toml::table& table, std::string_view key) const {
  const toml::node* node = table.get(key);
  if (!node) fail(table, std::string(key) + " is missing");
  return *node;
}

const toml::table& TomlReader::needed_table(const toml::table& table, std::string_view key) const {
  const toml::node& node = needed(table, key);
  if (!node.is_table()) fail(node, std::string(key) + " must be a table");
  return *node.as_table();
}

std::string TomlReader::text(const toml::table& table, std::string_view key) const {
  const toml::node& node = needed(table, key);
  if (!node.is_string()) fail(node, std::string(key) + " must be a text");
  return node.as_string()->get();
}

std::string TomlReader::word(const toml::table& table, std::string_view key, const std::vector<std::string_view>& known,
                             std::string_view otherwise) const {
  if (!table.get(key)) return std::string(otherwise);
  const std::string given = text(table, key);
  if (std::find(known.begin(), known.end(), given) == known.end()) {
    std::string all;
    for (const std::string_view one : known) all += (all.empty() ? "" : ", ") + std::string(one);
    fail(*table.get(key), std::string(key) + " must be one of " + all);
  }
  return given;
}

double TomlReader::number(const toml::node& node, std::string_view key) const {
  const auto value = node.value<double>();
  if (!value || !node.is_number() || !std::isfinite(*value)) fail(node, std::string(key) + " must be a finite number");
  return *value;
}

std::int64_t TomlReader::whole(const toml::node& node, std::string_view key, std::int64_t low,
                               std::int64_t high) const {
  const auto* value = node.as_integer();
  if (!value || value->get() < low || value->get() > high)
    fail(node,
         std::string(key) + " must be a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  return value->get();
}

glm::dvec3 TomlReader::vector(const toml::node& node, std::string_view key) const {
  const toml::array* list = node.as_array();
  if (!list || list->size() != 3) fail(node, std::string(key) + " must be three finite numbers");
  return {number((*list)[0], key), number((*list)[1], key), number((*list)[2], key)};
}

glm::dvec2 TomlReader::growing_pair(const toml::node& node, std::string_view key) const {
  const toml::array* pair = node.as_array();
  if (!pair || pair->size() != 2) fail(node, std::string(key) + " must be two numbers");
  const glm::dvec2 out(number((*pair)[0], key), number((*pair)[1], key));
  if (!(out.x < out.y)) fail(node, std::string(key) + " must be in increasing order");
  return out;
}

}  // namespace riffler::base
