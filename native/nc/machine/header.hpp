// The first lines of the code that we write: for which machine it is, so that it is not read for another one.
#pragma once

#include <string>

#include "nc/machine/machine.hpp"
#include "nc/source.hpp"

namespace riffler::nc {

/// "Riffler 0.1.0, post NAME": the first comment.
std::string header_line(const Machine& machine);

/// FormatError naming the line where the text begins with our header and is for another machine, or its X Y Z mean
/// something else, than `machine`. Code for upright tools may be read for any machine whose X Y Z are the tip. The
/// source stands at its start before and after.
void check_header(NcSource& source, const Machine& machine);

}  // namespace riffler::nc
