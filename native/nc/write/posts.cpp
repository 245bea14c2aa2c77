// Creates the post of a language.
#include <algorithm>
#include <stdexcept>

#include "nc/write/post.hpp"

namespace riffler::nc {

namespace {

struct PostLanguage {
  std::string_view name;
  std::unique_ptr<Post> (*make)(const Machine& machine, PostOptions options);
};

#define RIFFLER_POST(name, extension) {#name, make_##name},
constexpr PostLanguage kPosts[] = {RIFFLER_LANGUAGES(RIFFLER_POST)};
#undef RIFFLER_POST

}  // namespace

std::unique_ptr<Post> make_post(const Machine& machine, PostOptions options) {
  const auto at = std::find_if(std::begin(kPosts), std::end(kPosts),
                               [&](const PostLanguage& l) { return l.name == machine.control().language; });
  if (at == std::end(kPosts)) throw std::invalid_argument("unknown language " + machine.control().language);
  return at->make(machine, std::move(options));
}

}  // namespace riffler::nc
