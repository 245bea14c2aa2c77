// The pens that are known by name: those that come with Riffler (device/geometry/*.toml), and files of the user's own.
#pragma once

#include <string_view>
#include <vector>

#include "riffler/base/descriptions.hpp"
#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

/// All pens, ours first, then every *.toml in the folders of RIFFLER_PENS (apart as in PATH) and in riffler/pens of the
/// user's folder for settings; of a file that cannot be read the description says why.
std::vector<base::DescriptionEntry> pens();

/// `name` is one of pens(), or the path of a .toml file. Throws std::invalid_argument that lists the known ones, and
/// what describe_pen throws.
PenGeometry load_pen(std::string_view name);

}  // namespace riffler::pen
