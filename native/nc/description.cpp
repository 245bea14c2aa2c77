#include "nc/description.hpp"

namespace {

/// toml++ asserts that a key begins like one, and damaged text shows that it need not.
struct NoKey {};

}  // namespace

#define TOML_ASSERT(condition) ((condition) ? static_cast<void>(0) : throw NoKey())
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <vector>

#include "geom/error.hpp"
#include "nc/post.hpp"

namespace riffler {

namespace {

constexpr double kMaxRotary = 3600;  // deg/min, where nothing else is said: ten turns a minute

class Describer {
 public:
  Describer(std::string_view text, const std::string& file) : file_(file), root_(parse(text)) {}

  std::string summary() { return text(root_, "description"); }

  MachineDescription describe(const std::string& name, OptionReader& options) {
    allow(root_, {"description", "control", "words", "direction", "tool_length", "feed", "note", "options", "rotary",
                  "axis", "start", "end"});
    summary();
    MachineDescription out;
    out.name = name;
    out.tip_words = word(root_, "words", {"tip", "joints"}, "tip") == "tip";
    if (root_["rotary"]) out.tip_words = options.flag("tcp", out.tip_words);
    const double tables = table_sign(options);
    take_options(options, !out.tip_words);
    if (toml::node* list = root_.get("rotary")) {
      if (!list->is_array_of_tables()) fail(*list, "rotary must be [[rotary]] tables");
      for (toml::node& entry : *list->as_array()) out.rotary.push_back(rotary_axis(*entry.as_table(), tables));
    }
    ranges(out, options);
    control(out, options);
    return out;
  }

 private:
  toml::table parse(std::string_view text) const {
    check_ascii(text);
    try {
      return toml::parse(text);
    } catch (const toml::parse_error& e) {
      throw FormatError(file_, "line " + std::to_string(e.source().begin.line), std::string(e.description()));
    } catch (const NoKey&) {
      throw FormatError(file_, "line " + std::to_string(line_without_key(text)), "a key is expected");
    }
  }

  /// Outside comments and strings TOML is ASCII; toml++ 3.3 is undefined for some of what is not.
  void check_ascii(std::string_view text) const {
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

  /// The first line up to which the text has that fault.
  static int line_without_key(std::string_view text) {
    int line = 1;
    for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n', end + 1), ++line) {
      try {
        static_cast<void>(toml::parse(text.substr(0, end)));
      } catch (const NoKey&) {
        break;
      } catch (const toml::parse_error&) {
      }
    }
    return line;
  }

  [[noreturn]] void fail(const toml::node& at, const std::string& what) const {
    throw FormatError(file_, "line " + std::to_string(at.source().begin.line), what);
  }

  void allow(const toml::table& table, std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, node] : table)
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
        fail(node, "unknown key " + std::string(key.str()));
  }

  const toml::node& needed(const toml::table& table, std::string_view key) const {
    const toml::node* node = table.get(key);
    if (!node) fail(table, std::string(key) + " is missing");
    return *node;
  }

  std::string text(const toml::table& table, std::string_view key) const {
    const toml::node& node = needed(table, key);
    if (!node.is_string()) fail(node, std::string(key) + " must be a text");
    return node.as_string()->get();
  }

  std::string word(const toml::table& table, std::string_view key, const std::vector<std::string_view>& known,
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

  double number(const toml::node& node, std::string_view key) const {
    const auto value = node.value<double>();
    if (!value || !node.is_number() || !std::isfinite(*value))
      fail(node, std::string(key) + " must be a finite number");
    return *value;
  }

  Vec3 vector(const toml::node& node, std::string_view key) const {
    const toml::array* list = node.as_array();
    if (!list || list->size() != 3) fail(node, std::string(key) + " must be three finite numbers");
    return {number((*list)[0], key), number((*list)[1], key), number((*list)[2], key)};
  }

  /// −1 where the caller wants tables to turn the other way than the file has it.
  double table_sign(OptionReader& options) const {
    if (!root_.get("direction")) return 1;
    const std::string own = word(root_, "direction", {"linuxcnc", "iso"}, "");
    return options.word("direction", {"linuxcnc", "iso"}, own) == own ? 1 : -1;
  }

  /// The values of the options that the file declares.
  void take_options(OptionReader& options, bool joints) {
    const toml::node* node = root_.get("options");
    if (!node) return;
    if (!node->is_table()) fail(*node, "options must be a table");
    for (const auto& [key, declared] : *node->as_table()) {
      const std::string name(key.str());
      if (const toml::table* entry = declared.as_table()) {
        allow(*entry, {"needed", "about"});
        word(*entry, "needed", {"joints"}, "");
        const auto given = options.given(name);
        const double value = options.number(name, 0);
        if (joints && !given)
          throw std::invalid_argument(options.owner() + ": option " + name +
                                      " must be given: " + text(*entry, "about"));
        values_[name] = Vec3(value);
      } else if (declared.is_array()) {
        values_[name] = options.vector(name, vector(declared, name));
      } else {
        values_[name] = Vec3(options.number(name, number(declared, name)));
      }
    }
  }

  RotaryAxis rotary_axis(const toml::table& table, double tables) const {
    allow(table, {"letter", "carries", "axis", "at"});
    RotaryAxis out{};
    const std::string letter = word(table, "letter", {"A", "B", "C"}, "");
    if (letter.empty()) fail(table, "letter is missing");
    out.letter = letter[0];
    const std::string carries = word(table, "carries", {"part", "tool"}, "");
    if (carries.empty()) fail(table, "carries is missing");
    out.carries_part = carries == "part";
    const Vec3 axis = vector(needed(table, "axis"), "axis");
    if (!(glm::length(axis) > 1e-9)) fail(*table.get("axis"), "axis must not be zero");
    out.direction = (out.carries_part ? tables : 1) * glm::normalize(axis);
    if (const toml::node* at = table.get("at")) out.point = point(*at);
    return out;
  }

  /// Three numbers, or a sum of options, each times what the file has for it.
  Vec3 point(const toml::node& node) const {
    if (node.is_array()) return vector(node, "at");
    const toml::table* sum = node.as_table();
    if (!sum) fail(node, "at must be three numbers or a table of options");
    Vec3 out(0);
    for (const auto& [key, weights] : *sum) {
      const auto value = values_.find(std::string(key.str()));
      if (value == values_.end()) fail(weights, "at: there is no option " + std::string(key.str()));
      out += vector(weights, key.str()) * value->second;
    }
    return out;
  }

  void ranges(MachineDescription& out, OptionReader& options) const {
    if (const toml::node* all = root_.get("axis")) {
      if (!all->is_table()) fail(*all, "axis must be tables [axis.X]");
      for (const auto& [key, node] : *all->as_table()) {
        const std::string letter(key.str());
        if (letter.size() != 1 || kJointLetters.find(letter) == kJointLetters.npos || !node.is_table())
          fail(node, "axis must be tables [axis.X] of X Y Z A B C");
        const toml::table& table = *node.as_table();
        allow(table, {"limits", "rate"});
        AxisRange& range = out.ranges[joint_index(letter[0])];
        if (const toml::node* limits = table.get("limits")) {
          const toml::array* pair = limits->as_array();
          if (!pair || pair->size() != 2) fail(*limits, "limits must be two numbers");
          range.low = number((*pair)[0], "limits"), range.high = number((*pair)[1], "limits");
          if (!(range.low < range.high)) fail(*limits, "limits must grow");
        }
        if (const toml::node* rate = table.get("rate")) {
          range.rate = number(*rate, "rate");
          if (!(range.rate > 0)) fail(*rate, "rate must be positive");
        }
      }
    }
    const double most = options.positive("max_rotary").value_or(out.tip_words ? AxisRange{}.rate : kMaxRotary);
    for (std::size_t k = 0; k < out.ranges.size(); ++k) {
      const auto turns = [&](const RotaryAxis& axis) { return axis.letter == kJointLetters[k]; };
      if (k >= 3 && std::none_of(out.rotary.begin(), out.rotary.end(), turns)) continue;
      AxisRange& range = out.ranges[k];
      const std::string letter(1, static_cast<char>(kJointLetters[k] - 'A' + 'a'));
      if (const auto limits = options.range("limits_" + letter)) range.low = limits->first, range.high = limits->second;
      if (const auto rate = options.positive("rate_" + letter)) range.rate = *rate;
      if (k >= 3) range.rate = std::min(range.rate, most);
    }
  }

  void control(MachineDescription& out, OptionReader& options) const {
    Control& c = out.control;
    std::vector<std::string_view> languages;
    for (const PostLanguage& language : post_languages()) languages.push_back(language.name);
    c.language = word(root_, "control", languages, "rs274");
    const std::string own = word(root_, "tool_length", {"G43", "G43.4"}, "G43");
    if (c.language == "rs274") c.tool_length = options.word("tool_length", {"G43", "G43.4"}, own);
    const std::string feed =
        word(root_, "feed", {"inverse-time", "per-minute"}, out.tip_words ? "per-minute" : "inverse-time");
    c.inverse_time =
        c.language == "rs274" && options.word("feed", {"inverse-time", "per-minute"}, feed) == "inverse-time";
    if (const toml::node* note = root_.get("note")) {
      if (!note->is_table()) fail(*note, "note must be a table");
      allow(*note->as_table(), {"tip", "joints"});
      const char* key = out.tip_words ? "tip" : "joints";
      if (note->as_table()->get(key)) c.note = text(*note->as_table(), key);
    }
    c.start = lines("start"), c.end = lines("end");
  }

  std::vector<std::string> lines(std::string_view key) const {
    std::vector<std::string> out;
    const toml::node* node = root_.get(key);
    if (!node) return out;
    if (!node->is_array()) fail(*node, std::string(key) + " must be a list of texts");
    for (const toml::node& line : *node->as_array()) {
      const auto* text = line.as_string();
      const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
      if (!text || !std::all_of(text->get().begin(), text->get().end(), printable))
        fail(line, std::string(key) + " must be a list of texts in printable ASCII, one block each");
      out.push_back(text->get());
    }
    return out;
  }

  const std::string& file_;
  toml::table root_;
  std::map<std::string, Vec3> values_;  // numbers three times
};

}  // namespace

MachineDescription describe_machine(std::string_view toml, const std::string& file, const std::string& name,
                                    OptionReader& options) {
  return Describer(toml, file).describe(name, options);
}

std::string machine_summary(std::string_view toml, const std::string& file) {
  return Describer(toml, file).summary();
}

}  // namespace riffler
