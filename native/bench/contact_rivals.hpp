// Queries of FCL and Coal; each is built only where the library is installed. Both test triangles and return neither
// force nor depth.
#pragma once

#include "bench/contact_run.hpp"

namespace riffler::bench {

std::vector<Ask> fcl_asks(const ContactCase& scene);
std::vector<Ask> coal_asks(const ContactCase& scene);

}  // namespace riffler::bench
