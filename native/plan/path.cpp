#include "plan/path.hpp"

namespace riffler {

double PencilPath::length() const {
  double sum = 0;
  for (std::size_t k = 1; k < centres.size(); ++k) sum += glm::length(centres[k] - centres[k - 1]);
  return closed && centres.size() > 1 ? sum + glm::length(centres.front() - centres.back()) : sum;
}

}  // namespace riffler
