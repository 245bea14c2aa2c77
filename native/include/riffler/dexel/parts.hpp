// The separate pieces of a volume.
#pragma once

#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// One volume for each piece that hangs together, the largest first, equal ones by where their first ray stands. They
/// share the volume's frame, and their spans are the volume's, each in one of them.
///
/// Spans of neighbouring rays hang together where they overlap, and rays of two directions where both hold the point in
/// which they meet. What no ray of the reference direction sees, as a fin thinner than the pitch may be, goes with the
/// largest piece, and so do pieces smaller than `least` mm³. An empty volume has no pieces. Throws
/// std::invalid_argument for more than `kMaxParts`.
std::vector<Volume> parts(const Volume& volume, double least = 0, const Progress& progress = {});

inline constexpr std::size_t kMaxParts = 1000;

}  // namespace riffler::dexel
