// The list of languages, and what all of them are asked for.
#include <algorithm>
#include <stdexcept>

#include "nc/limits.hpp"
#include "nc/post.hpp"

namespace riffler {

namespace {

constexpr PostLanguage kLanguages[] = {
    {"rs274", make_rs274},
    {"heidenhain", make_heidenhain},
    {"apt", make_apt},
};

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

PostOptions take_post_options(OptionReader& options) {
  PostOptions out;
  const double step = options.number("line_numbers", 0);
  if (!(step >= 0 && step <= 1000 && step == static_cast<int>(step)))
    throw std::invalid_argument(options.owner() + ": option line_numbers must be a whole step up to 1000; 0: none");
  out.line_numbers = static_cast<int>(step);
  out.coolant = options.word("coolant", {"off", "flood", "mist"}, "off");
  out.vectors = options.flag("vectors", false);
  const bool retracts = options.given("retract");
  const double retract = options.number("retract", 0);
  if (retracts) {
    out.retract = retract;
    if (!(std::abs(retract) <= kMaxLength))
      throw std::invalid_argument(options.owner() + ": option retract is out of range");
  }
  out.arcs = options.flag("arcs", false);
  return out;
}

}  // namespace riffler
