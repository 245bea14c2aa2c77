// The options of NC code, which the writer and the readers of a machine's programs take alike.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "nc/options.hpp"

namespace riffler {

/// What a machine's control may read. The writer has a post for each (nc/write/posts.cpp), the reader an interpreter.
inline constexpr std::array<std::string_view, 4> kLanguages{"rs274", "heidenhain", "sinumerik", "apt"};

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

}  // namespace riffler
