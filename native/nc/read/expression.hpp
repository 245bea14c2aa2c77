// Values in NC code: numbers, parameters, functions and [expressions].
#pragma once

#include "nc/read/cursor.hpp"
#include "nc/read/parameters.hpp"

namespace riffler::nc {

/// Reads the next value: a number, #parameter, function or [expression], after an optional sign. `what`: the letter of
/// its word, for messages. Throws FormatError for malformed input and for values that are not finite.
///
/// Precedence as in LinuxCNC, left to right within a group: **; * / MOD; + −; EQ NE GT GE LT LE; AND OR XOR. Angles are
/// in degrees; EQ and NE treat values within 1e-4 as equal; the result of MOD is never negative.
double nc_value(NcCursor& cursor, const NcParameters& parameters, const NcPlace& place, char what);

/// Reads what follows "#" up to "=", a number or a name, and the value, and assigns it (NcParameters::assign).
void nc_assignment(NcCursor& cursor, NcParameters& parameters, const NcPlace& place);

}  // namespace riffler::nc
