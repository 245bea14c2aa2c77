// What the arguments of programs have in common: columns, tools by number, provenance.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bindings/program_types.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::bindings {

using ProgramClass = py::class_<nc::Program, std::shared_ptr<nc::Program>>;

// The topics of bind_program, in the order in which module.cpp calls them.
void bind_machines(py::module_& m);
void bind_nc_types(py::module_& m);
void bind_nc(py::module_& m);
void bind_program_paths(py::module_& m);

/// The class, for the files that add a topic to it.
ProgramClass program_class(const py::module_& m);

/// ValueError naming `name` for anything but an array of numbers.
Doubles to_doubles(const py::handle& object, const std::string& name);

/// One number for all rows, or one per row. A single number stays single where `spread` is false.
std::vector<double> to_column(const py::handle& object, std::size_t rows, const std::string& name, bool spread = true);

/// Curves of points (n, 3); ValueError naming the curve, as "curves[2]".
std::vector<std::vector<Vec3>> to_curves(const ArraysLike& arrays, const std::string& name);

/// A whole number from 0 to nc::kMaxNumber; ValueError naming `name` and the row.
int to_number(double value, const std::string& name, std::size_t row);

/// None, or a dict of number to Tool. ValueError for other types and for numbers below `lowest`.
std::map<int, Tool> to_tools(const ToolsLike& object, int lowest);

/// None, or a dict, whose keys and values become strings.
nc::Provenance to_provenance(const StringsLike& object);

}  // namespace riffler::bindings
