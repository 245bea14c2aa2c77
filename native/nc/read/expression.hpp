// Values in NC code: numbers, parameters, functions and [expressions].
#pragma once

#include "nc/read/cursor.hpp"
#include "nc/read/parameters.hpp"

namespace riffler::nc {

/// The value that comes next: a number, #parameter, function or [expression], after a sign or none. `what` is the
/// letter of its word, for messages. FormatError for what is malformed or has no finite value.
///
/// Operators bind as on LinuxCNC, those of one line from left to right: **; * / MOD; + −; EQ NE GT GE LT LE;
/// AND OR XOR. Angles are degrees; EQ and NE take values within 1e-4 for equal; MOD has the sign of its divisor's
/// magnitude, so never a negative value.
double nc_value(NcCursor& cursor, const NcParameters& parameters, const NcPlace& place, char what);

/// Takes what follows "#" up to its "=": a number or a name, and the value, which it assigns (NcParameters::assign).
void nc_assignment(NcCursor& cursor, NcParameters& parameters, const NcPlace& place);

}  // namespace riffler::nc
