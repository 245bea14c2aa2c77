#include "nc/machine/description.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <vector>

#include "base/toml.hpp"
#include "nc/machine/post_options.hpp"

namespace riffler::nc {

namespace {

constexpr double kMaxRotary = 3600;  // deg/min, default: ten turns per minute

class Describer : base::TomlReader {
 public:
  Describer(std::string_view text, const std::string& file) : base::TomlReader(text, file) {}

  std::string summary() const { return text(root(), "description"); }

  MachineTexts texts() const { return {summary(), language(), translations()}; }

  MachineDescription describe(const std::string& name, OptionReader& options) {
    allow(root(), {"description", "control", "words", "direction", "tool_length", "feed", "note", "options", "rotary",
                   "axis", "start", "end", "retract", "coolant", "rapids", "translations"});
    texts();
    MachineDescription out;
    out.name = name;
    out.tip_words = word(root(), "words", {"tip", "joints"}, "tip") == "tip";
    if (root().get("rotary")) out.tip_words = options.flag("tcp", out.tip_words);
    const double tables = table_sign(options);
    take_options(options, !out.tip_words);
    if (toml::node* list = root().get("rotary")) {
      if (!list->is_array_of_tables()) fail(*list, "rotary must be [[rotary]] tables");
      for (toml::node& entry : *list->as_array()) out.rotary.push_back(rotary_axis(*entry.as_table(), tables));
    }
    ranges(out, options);
    control(out, options);
    return out;
  }

 private:
  std::string language() const { return word(root(), "control", {kLanguages.begin(), kLanguages.end()}, "rs274"); }

  std::map<std::string, std::map<std::string, std::string>> translations() const {
    std::map<std::string, std::map<std::string, std::string>> out;
    if (!root().get("translations")) return out;
    for (const auto& [code, texts] : needed_table(root(), "translations")) {
      if (!texts.is_table()) fail(texts, "translations must be tables [translations.LANGUAGE]");
      std::map<std::string, std::string>& own = out[std::string(code.str())];
      for (const auto& [key, node] : *texts.as_table()) {
        if (key.str() == "description")
          own[summary()] = text(*texts.as_table(), "description");
        else
          translate_option(node, std::string(key.str()), own);
      }
    }
    return out;
  }

  void translate_option(const toml::node& node, const std::string& name,
                        std::map<std::string, std::string>& own) const {
    const toml::node* declared = root().at_path("options").is_table() ? root()["options"][name].node() : nullptr;
    if (!declared) fail(node, "translations: there is no option " + name);
    if (!node.is_table()) fail(node, name + " must be a table of name and about");
    const toml::table& texts = *node.as_table();
    allow(texts, {"name", "about"});
    own[name] = text(texts, "name");
    if (!declared->is_table() || !declared->as_table()->get("about")) return;
    own[text(*declared->as_table(), "about")] = text(texts, "about");
  }

  /// −1 if the caller reverses the rotation of tables relative to the file.
  double table_sign(OptionReader& options) const {
    if (!root().get("direction")) return 1;
    const std::string own = word(root(), "direction", {"linuxcnc", "iso"}, "");
    return options.word("direction", {"linuxcnc", "iso"}, own) == own ? 1 : -1;
  }

  /// Reads the values of the options that the file declares.
  void take_options(OptionReader& options, bool joints) {
    const toml::node* node = root().get("options");
    if (!node) return;
    if (!node->is_table()) fail(*node, "options must be a table");
    for (const auto& [key, declared] : *node->as_table()) {
      const std::string name(key.str());
      values_[name] = declared.is_table() ? described(options, name, *declared.as_table(), joints)
                                          : with_value(options, name, declared, "");
    }
  }

  /// An option with its description: required if the words are joints, otherwise with a default.
  Vec3 described(OptionReader& options, const std::string& name, const toml::table& entry, bool joints) const {
    allow(entry, {"needed", "about", "numbers", "value"});
    const std::string about = text(entry, "about");
    if (const toml::node* value = entry.get("value")) {
      if (entry.get("needed") || entry.get("numbers")) fail(*value, "an option with a value is not needed");
      return with_value(options, name, *value, about);
    }
    word(entry, "needed", {"joints"}, "");
    const toml::node* numbers = entry.get("numbers");
    const double count = numbers ? number(*numbers, "numbers") : 1;
    if (count != 1 && count != 3) fail(*numbers, "numbers must be 1 or 3");
    return options.of_machine(name, static_cast<std::size_t>(count), std::nullopt, joints, about);
  }

  Vec3 with_value(OptionReader& options, const std::string& name, const toml::node& value,
                  const std::string& about) const {
    if (value.is_array()) return options.of_machine(name, 3, vector(value, name), false, about);
    return options.of_machine(name, 1, Vec3(number(value, name)), false, about);
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

  /// Three numbers, or a sum of options times factors from the file.
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
    if (const toml::node* all = root().get("axis")) {
      if (!all->is_table()) fail(*all, "axis must be tables [axis.X]");
      for (const auto& [key, node] : *all->as_table()) {
        const std::string letter(key.str());
        if (letter.size() != 1 || kJointLetters.find(letter) == kJointLetters.npos || !node.is_table())
          fail(node, "axis must be tables [axis.X] of X Y Z A B C");
        const toml::table& table = *node.as_table();
        allow(table, {"limits", "rate"});
        AxisRange& range = out.ranges[joint_index(letter[0])];
        if (const toml::node* given = table.get("limits")) {
          const Vec2 limits = growing_pair(*given, "limits");
          range.low = limits.x, range.high = limits.y;
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
    c.language = language();
    const std::string own = word(root(), "tool_length", {"G43", "G43.4"}, "G43");
    if (c.language == "rs274") c.tool_length = options.word("tool_length", {"G43", "G43.4"}, own);
    const std::string feed =
        word(root(), "feed", {"inverse-time", "per-minute"}, out.tip_words ? "per-minute" : "inverse-time");
    c.inverse_time =
        c.language == "rs274" && options.word("feed", {"inverse-time", "per-minute"}, feed) == "inverse-time";
    const std::vector<std::string> ways{"straight", "independent", "unknown"};
    c.rapids = options.word("rapids", ways, word(root(), "rapids", {"straight", "independent", "unknown"}, "unknown"));
    if (const toml::node* note = root().get("note")) {
      if (!note->is_table()) fail(*note, "note must be a table");
      allow(*note->as_table(), {"tip", "joints"});
      const char* key = out.tip_words ? "tip" : "joints";
      if (note->as_table()->get(key)) c.note = text(*note->as_table(), key);
    }
    c.start = lines("start"), c.end = lines("end"), c.retract = lines("retract");
    c.coolant = word(root(), "coolant", {"off", "flood", "mist"}, "off");
  }

  std::vector<std::string> lines(std::string_view key) const {
    std::vector<std::string> out;
    const toml::node* node = root().get(key);
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

  std::map<std::string, Vec3> values_;  // a number is stored three times
};

}  // namespace

MachineDescription describe_machine(std::string_view toml, const std::string& file, const std::string& name,
                                    OptionReader& options) {
  return Describer(toml, file).describe(name, options);
}

MachineTexts machine_texts(std::string_view toml, const std::string& file) {
  return Describer(toml, file).texts();
}

std::string machine_summary(std::string_view toml, const std::string& file) {
  return Describer(toml, file).summary();
}

}  // namespace riffler::nc
