// Header of the NC code that Riffler writes: names the machine, so that the code is not read for another one.
#pragma once

#include <string>

#include "nc/machine/machine.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// The first comment: "Riffler 0.1.0, post NAME".
std::string header_line(const Machine& machine);

/// Throws FormatError naming the line if the text begins with this header for another machine, or with another meaning
/// of X Y Z. Code for vertical tools may be read for any machine with tip coordinates. Leaves the source at its start.
void check_header(NcSource& source, const Machine& machine);

}  // namespace riffler::nc
