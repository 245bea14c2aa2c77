// The list of languages, and what all of them are asked for.
#include <algorithm>
#include <stdexcept>

#include "nc/limits.hpp"
#include "nc/write/post.hpp"

namespace riffler {

namespace {

constexpr PostLanguage kLanguages[] = {
    {"rs274", make_rs274},
    {"heidenhain", make_heidenhain},
    {"sinumerik", make_sinumerik},
    {"apt", make_apt},
};

/// A coordinate in mm, where it is given.
std::optional<double> place(OptionReader& options, const std::string& name) {
  const std::optional<double> value = options.finite(name);
  if (value && !(std::abs(*value) <= kMaxLength))
    throw std::invalid_argument(options.owner() + ": option " + name + " is out of range");
  return value;
}

}  // namespace

std::span<const PostLanguage> post_languages() {
  return kLanguages;
}

std::unique_ptr<Post> make_post(const Machine& machine, PostOptions options) {
  const auto at = std::find_if(std::begin(kLanguages), std::end(kLanguages),
                               [&](const PostLanguage& l) { return l.name == machine.control().language; });
  if (at == std::end(kLanguages)) throw std::invalid_argument("unknown language " + machine.control().language);
  return at->make(machine, std::move(options));
}

PostOptions take_post_options(OptionReader& options, const std::string& coolant) {
  PostOptions out;
  const double step = options.number("line_numbers", 0);
  if (!(step >= 0 && step <= 1000 && step == static_cast<int>(step)))
    throw std::invalid_argument(options.owner() + ": option line_numbers must be a whole step up to 1000; 0: none");
  out.line_numbers = static_cast<int>(step);
  out.coolant = options.word("coolant", {"off", "flood", "mist"}, coolant);
  out.vectors = options.flag("vectors", false);
  out.retract = place(options, "retract");
  out.safe_start = options.flag("safe_start", true);
  out.safe_height = place(options, "safe_height");
  out.arcs = options.flag("arcs", false);
  return out;
}

}  // namespace riffler
