// What FCL and Coal are asked, each built where it is there. Both get triangles alone: no force, no depth.
#pragma once

#include "bench/contact_run.hpp"

namespace riffler::bench {

std::vector<Ask> fcl_asks(const ContactCase& scene);
std::vector<Ask> coal_asks(const ContactCase& scene);

}  // namespace riffler::bench
