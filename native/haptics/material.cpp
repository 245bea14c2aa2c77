#include "haptics/material.hpp"

#include "haptics/settings.hpp"

namespace riffler {

void Material::validate(const std::string& what) const {
  require_not_negative((what + ": stiffness").c_str(), stiffness);
  require_not_negative((what + ": removal_constant").c_str(), removal_constant);
  require_not_negative((what + ": damping").c_str(), damping);
  require_positive((what + ": density").c_str(), density);
}

}  // namespace riffler
