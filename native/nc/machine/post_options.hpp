// Options of NC code that the writer and the readers of a machine's programs share.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "nc/options.hpp"

namespace riffler::nc {

/// The languages that a control may read, each with the usual extension of its files. `make_<language>` in
/// nc/write/post_<language>.cpp makes the post: a new language needs an entry here, a post and a machine file.
#define RIFFLER_LANGUAGES(X) X(rs274, ".ngc") X(heidenhain, ".h") X(sinumerik, ".mpf") X(apt, ".apt")

#define RIFFLER_LANGUAGE_NAME(name, extension) std::string_view(#name),
inline constexpr std::array kLanguages{RIFFLER_LANGUAGES(RIFFLER_LANGUAGE_NAME)};
#undef RIFFLER_LANGUAGE_NAME

/// The usual extension of files in one of kLanguages, with its dot; empty for another word.
constexpr std::string_view file_extension(std::string_view language) {
#define RIFFLER_LANGUAGE_EXTENSION(name, extension) \
  if (language == #name) return extension;
  RIFFLER_LANGUAGES(RIFFLER_LANGUAGE_EXTENSION)
#undef RIFFLER_LANGUAGE_EXTENSION
  return {};
}

/// Layout of the text, for every post.
struct PostOptions {
  int line_numbers = 0;  ///< step of N words; 0: none. Heidenhain always numbers its blocks
  std::string coolant;   ///< "flood", "mist" or empty
  bool vectors = false;  ///< Heidenhain: LN blocks with the tool's axis instead of rotary words
  /// Machine Z (G53, mm) to which the tool retracts at the start, before tool changes and at the end, instead of the
  /// retract blocks in the machine's file.
  std::optional<double> retract;
  /// If the machine's file says how to retract: retract first, turn the rotary axes there, then move across, then down.
  /// Otherwise the first block, and the one after a tool change, moves straight from the machine's position.
  bool safe_start = true;
  std::optional<double> safe_height;  ///< mm, z of the tip above everything; default: the highest point of the program
  bool arcs = false;                  ///< replace line segments with a constant axis by G2, G3 within the tolerance
};

/// Takes the options of posts. `coolant`: default from the machine's file.
PostOptions take_post_options(OptionReader& options, const std::string& coolant = "off");

}  // namespace riffler::nc
