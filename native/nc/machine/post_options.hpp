// The options of NC code, which the writer and the readers of a machine's programs take alike.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "nc/options.hpp"

namespace riffler::nc {

/// The languages that a machine's control may read. `make_<language>` in nc/write/post_<language>.cpp makes the post of
/// each: a new language is a word here, its post and a machine's file.
#define RIFFLER_LANGUAGES(X) X(rs274) X(heidenhain) X(sinumerik) X(apt)

#define RIFFLER_LANGUAGE_NAME(name) std::string_view(#name),
inline constexpr std::array kLanguages{RIFFLER_LANGUAGES(RIFFLER_LANGUAGE_NAME)};
#undef RIFFLER_LANGUAGE_NAME

/// How the text is to look; of every post.
struct PostOptions {
  int line_numbers = 0;  ///< step of N words; 0: none. Heidenhain counts its blocks whatever it is
  std::string coolant;   ///< "flood", "mist" or none
  bool vectors = false;  ///< Heidenhain: LN blocks with the tool's axis, no rotary words
  /// Machine Z (G53, mm) to which the tool goes before everything, before tool changes and after everything, in place
  /// of the machine's own way there.
  std::optional<double> retract;
  /// Retract first, turn the rotary axes there, then across, then down, where the machine's file says how to retract.
  /// Otherwise the first block, and the one after a tool change, goes straight from wherever the machine is.
  bool safe_start = true;
  std::optional<double> safe_height;  ///< mm, z of the tip above everything; not given: as high as the program goes
  bool arcs = false;                  ///< straight runs with one axis become G2, G3 within the tolerance
};

/// `coolant`: what the machine's file says, where the option is not given.
PostOptions take_post_options(OptionReader& options, const std::string& coolant = "off");

}  // namespace riffler::nc
