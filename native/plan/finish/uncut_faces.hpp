// Pieces of rows on faces that a pattern's rows have missed.
#pragma once

#include "plan/finish/patterns.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::plan {

/// Adds pieces wherever the rows leave more than cusp and tolerance on a selected face that the cutter reaches, at
/// samples of the faces themselves. Patterns look for their rows at places of the tool, and miss faces whose places lie
/// between those: small level faces under a flat end, and strips along borders. Faces steeper than 74° are left out.
void cut_uncut_faces(const PatternScene& scene, PatternRows& rows, const Progress& progress);

}  // namespace riffler::plan
