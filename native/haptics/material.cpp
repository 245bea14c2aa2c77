#include "riffler/haptics/material.hpp"

#include "riffler/haptics/settings.hpp"

namespace riffler {

void Material::validate(const std::string& what) const {
  require_not_negative(stiffness, what + ": stiffness");
  require_not_negative(removal_constant, what + ": removal_constant");
  require_not_negative(damping, what + ": damping");
  require_positive(density, what + ": density");
}

}  // namespace riffler
