// Splits a volume into its connected pieces.
#pragma once

#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// Returns one volume for each connected piece, largest first; equal pieces are ordered by their first ray. They have
/// the volume's frame, and each of its spans is in exactly one of them.
///
/// Spans of neighbouring rays are connected if they overlap; rays of two directions, if both contain their crossing
/// point. Material that no ray of the reference direction meets, such as a fin thinner than the pitch, goes to the
/// largest piece, and so do pieces smaller than `least` mm³. An empty volume has no pieces. Throws
/// std::invalid_argument for more than `kMaxParts` pieces.
std::vector<Volume> parts(const Volume& volume, double least = 0, const Progress& progress = {});

inline constexpr std::size_t kMaxParts = 1000;

}  // namespace riffler::dexel
