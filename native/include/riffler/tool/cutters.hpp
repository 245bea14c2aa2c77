// The named cutters: a table of their shapes, and one C++ function for each.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "riffler/tool/tool.hpp"

namespace riffler::tool {

enum class SizeUnit : unsigned char { Length, Angle, Flag };  ///< mm; rad; 0 or 1

/// One size of a shape. A size has the same meaning in every shape that uses it, so a form needs one field for it.
struct CutterSize {
  const char* name;  ///< argument name in Python, in dicts and on the command line
  SizeUnit unit;
  const char *label, *description;  ///< text of the form field
  double low, high, initial;        ///< range and default of the form field; `initial` suits a 6 mm cutter
  double largest = 0;               ///< upper limit of the form field as a multiple of the diameter; 0: no limit
  bool may_be_zero = false;         ///< otherwise a length must be positive
};

/// The parameters d, r, e, f, a, b, h of APT's CUTTER statement (ISO 4343). Lengths in mm, angles in rad.
struct AptCutter {
  double d;     ///< diameter
  double r;     ///< corner radius
  double e, f;  ///< corner centre: distance from the axis, height above the tip
  double a, b;  ///< angle between the end and the plane normal to the axis; angle between flank and axis
  double h;     ///< length
};

/// One row of the table. The Python functions and dict form, the command line, the CUTTER statements of APT files and
/// Blender's panels are generated from it. Blender files store a shape's row number, so append new shapes at the end.
struct CutterShape {
  const char *name, *label, *description;
  std::span<const CutterSize> sizes;                   ///< in the order of arguments; one is "diameter", one "length"
  Profile (*profile)(std::span<const double> sizes);   ///< throws std::invalid_argument if sizes do not fit together
  AptCutter (*to_apt)(std::span<const double> sizes);  ///< null if CUTTER cannot describe the shape
  std::optional<std::vector<double>> (*from_apt)(const AptCutter&);  ///< sizes, nothing for other shapes; may be null
};

/// All rows of the table.
std::span<const CutterShape> cutter_shapes();
/// The row with this name, or null. The free profile has no sizes and no row.
const CutterShape* find_cutter_shape(std::string_view name);
/// Makes a cutter. Throws std::invalid_argument naming the size that is out of range or does not fit.
Tool make_cutter(const CutterShape& shape, std::span<const double> sizes);
/// The sizes that `tool` was made from, or nothing if it lacks one of the shape's sizes.
std::optional<std::vector<double>> sizes_of(const Tool& tool, const CutterShape& shape);
/// Whether the tool's parameter of this name is a flag.
bool is_flag(const Tool& tool, std::string_view parameter);

namespace cutters {

/// Lengths in mm. Each function throws std::invalid_argument naming the size that is not positive and finite or does
/// not fit.
Tool ball(double diameter, double length);
Tool flat(double diameter, double length);
/// Bull nose. Its major radius is e = diameter / 2 − corner_radius.
Tool fillet(double diameter, double corner_radius, double length);
/// A ball tip with a tangent cone of `half_angle` (rad, between axis and flank) up to `diameter`, then a cylinder.
/// `flat_tip` replaces the ball with a flat end.
Tool taper(double tip_radius, double half_angle, double diameter, double length, bool flat_tip = false);
/// A sharp tip, a cone up to the height `tip_height`, a second cone up to `diameter`, then a cylinder. Half angles in
/// rad.
Tool cone_end(double tip_half_angle, double tip_height, double half_angle, double diameter, double length);
/// Any profile of lines and arcs. If it ends below `length`, a cylinder continues it.
Tool profile(std::vector<ProfileSegment> segments, double length);

}  // namespace cutters

}  // namespace riffler::tool

namespace riffler {
namespace cutters = tool::cutters;
}  // namespace riffler
