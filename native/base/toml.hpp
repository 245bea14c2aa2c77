// Reads descriptions in TOML, checks their values, and reports file and line in every message. Only this file includes
// toml++, which must be configured the same everywhere.
#pragma once

namespace riffler::base {

/// toml++ asserts that a key starts with a valid character, which damaged text can violate.
struct NoTomlKey {};

}  // namespace riffler::base

#define TOML_ASSERT(condition) ((condition) ? static_cast<void>(0) : throw riffler::base::NoTomlKey())
// In builds with assertions, some of these are inside noexcept functions; they guard toml++'s own invariants.
#pragma GCC diagnostic push
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wterminate"
#endif
#include <toml++/toml.h>
#pragma GCC diagnostic pop

#include <glm/glm.hpp>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace riffler::base {

/// Base class for readers of one kind of file. All functions throw FormatError naming file, line and what was expected;
/// `key` appears in messages. `file` must outlive the reader.
class TomlReader {
 protected:
  TomlReader(std::string_view text, const std::string& file) : file_(file), root_(parse(text)) {}

  toml::table& root() { return root_; }
  const toml::table& root() const { return root_; }

  [[noreturn]] void fail(const toml::node& at, const std::string& what) const;
  /// Throws unless every key of `table` is one of `keys`.
  void allow(const toml::table& table, std::initializer_list<std::string_view> keys) const;
  const toml::node& needed(const toml::table& table, std::string_view key) const;
  const toml::table& needed_table(const toml::table& table, std::string_view key) const;
  std::string text(const toml::table& table, std::string_view key) const;
  /// One of the words `known`; `otherwise` if the key is missing.
  std::string word(const toml::table& table, std::string_view key, const std::vector<std::string_view>& known,
                   std::string_view otherwise) const;
  /// A finite number.
  double number(const toml::node& node, std::string_view key) const;
  double number(const toml::table& table, std::string_view key) const { return number(needed(table, key), key); }
  /// An integer from `low` to `high`.
  std::int64_t whole(const toml::node& node, std::string_view key, std::int64_t low, std::int64_t high) const;
  glm::dvec3 vector(const toml::node& node, std::string_view key) const;
  /// Two finite numbers in increasing order.
  glm::dvec2 growing_pair(const toml::node& node, std::string_view key) const;

 private:
  toml::table parse(std::string_view text) const;
  void check_ascii(std::string_view text) const;

  const std::string& file_;
  toml::table root_;
};

}  // namespace riffler::base
