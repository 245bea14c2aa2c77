#include "riffler/brush/options.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::brush {

double falloff_at(Falloff falloff, double t) {
  if (!(t < 1)) return 0;
  const double p = 1 - std::max(t, 0.0);
  switch (falloff) {
    case Falloff::Smooth:
      return p * p * (3 - 2 * p);
    case Falloff::Smoother:
      return p * p * p * (p * (6 * p - 15) + 10);
    case Falloff::Sphere:
      return std::sqrt(p * (2 - p));
    case Falloff::Root:
      return std::sqrt(p);
    case Falloff::Sharp:
      return p * p;
    case Falloff::Linear:
      return p;
    case Falloff::Sharper:
      return p * p * p * p;
    case Falloff::InverseSquare:
      return p * (2 - p);
    case Falloff::Constant:
      break;
  }
  return 1;
}

}  // namespace riffler::brush
