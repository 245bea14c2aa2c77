// Pens by name: those shipped with Riffler (device/geometry/*.toml), and the user's own files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "riffler/base/descriptions.hpp"
#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

/// All pens: the shipped ones, then every *.toml in the folders of RIFFLER_PENS (separated as in PATH) and in
/// riffler/pens of the user's configuration folder. The description of an unreadable file states the reason.
std::vector<base::DescriptionEntry> pens();

/// `name`: from pens(), or the path of a .toml file. Throws std::invalid_argument listing the known names, and errors
/// of describe_pen.
PenGeometry load_pen(std::string_view name);

/// Whether the user's own files have a pen of this name.
bool is_own_pen(std::string_view name);

/// The TOML text that load_pen reads. Throws std::invalid_argument as above.
std::string pen_text(std::string_view name);

}  // namespace riffler::pen
