// Descriptions in TOML: a text taken apart, its values checked, every message with file and line. The one place that
// includes toml++, which must be set up alike wherever it is.
#pragma once

namespace riffler::base {

/// toml++ asserts that a key begins like one, and damaged text shows that it need not.
struct NoTomlKey {};

}  // namespace riffler::base

#define TOML_ASSERT(condition) ((condition) ? static_cast<void>(0) : throw riffler::base::NoTomlKey())
// In builds with assertions some are in functions that may not throw; those guard toml++ against itself.
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

/// To be derived from by what reads one kind of file. All of it throws FormatError naming file, line and what was
/// expected there; `key` stands in messages. `file` must outlive the reader.
class TomlReader {
 protected:
  TomlReader(std::string_view text, const std::string& file) : file_(file), root_(parse(text)) {}

  toml::table& root() { return root_; }
  const toml::table& root() const { return root_; }

  [[noreturn]] void fail(const toml::node& at, const std::string& what) const;
  /// Every key of `table` is one of these.
  void allow(const toml::table& table, std::initializer_list<std::string_view> keys) const;
  const toml::node& needed(const toml::table& table, std::string_view key) const;
  const toml::table& needed_table(const toml::table& table, std::string_view key) const;
  std::string text(const toml::table& table, std::string_view key) const;
  /// One of `known`, `otherwise` where the key is not there.
  std::string word(const toml::table& table, std::string_view key, const std::vector<std::string_view>& known,
                   std::string_view otherwise) const;
  /// Finite.
  double number(const toml::node& node, std::string_view key) const;
  double number(const toml::table& table, std::string_view key) const { return number(needed(table, key), key); }
  /// An integer from `low` to `high`.
  std::int64_t whole(const toml::node& node, std::string_view key, std::int64_t low, std::int64_t high) const;
  glm::dvec3 vector(const toml::node& node, std::string_view key) const;
  /// Two finite numbers, the first the smaller.
  glm::dvec2 growing_pair(const toml::node& node, std::string_view key) const;

 private:
  toml::table parse(std::string_view text) const;
  void check_ascii(std::string_view text) const;

  const std::string& file_;
  toml::table root_;
};

}  // namespace riffler::base
