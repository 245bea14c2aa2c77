// What the arguments of Journal and JournalWriter have in common.
#pragma once

#include "bindings/brush_names.hpp"
#include "bindings/program_types.hpp"
#include "riffler/session/journal.hpp"

namespace riffler::bindings {

/// The functions of riffler.JournalWriter.
void bind_journal_writer(py::module_& m);

py::object json();

/// A stroke without its name and tool.
session::JournalStroke to_rows(const Doubles& poses, const OptionalArrayLike& times, const OptionalArrayLike& forces,
                               const OptionalArrayLike& removed);
/// Throws if a stroke of a hand tool has no forward directions, or one of another tool has.
void check_roll(const session::JournalRules& rules, const session::JournalStroke& stroke);
session::JournalStock to_stock(const ArrayLike& lower, const ArrayLike& upper, double pitch,
                               const std::string& directions, const std::string& snapshot, const std::string& mask);

session::StrokeMode to_stroke_mode(const std::string& name);
const char* stroke_mode_name(session::StrokeMode mode);

}  // namespace riffler::bindings
