#include "riffler/haptics/material.hpp"

#include "riffler/haptics/settings.hpp"

namespace riffler::haptics {

void Material::validate(const std::string& what) const {
  base::require_not_negative(stiffness, what + ": stiffness");
  base::require_not_negative(removal_constant, what + ": removal_constant");
  base::require_not_negative(damping, what + ": damping");
  base::require_positive(density, what + ": density");
}

}  // namespace riffler::haptics
