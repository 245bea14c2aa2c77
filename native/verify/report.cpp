#include "verify/report.hpp"

#include <limits>
#include <string>

#include "marching/to_mesh.hpp"
#include "mesh/closest.hpp"

namespace riffler::verify {

void add_notes(VerifyReport& report, const std::vector<nc::Note>& notes) {
  for (const nc::Note& n : notes) {
    report.not_checked.push_back("line " + std::to_string(n.line) + ": " + n.message);
    report.uncertain = report.uncertain || n.kind == "coordinates" || n.kind == "work offset";
  }
}

std::pair<Mesh, std::vector<double>> deviation_of(const Volume& left, const Mesh& part, const Progress& progress) {
  Mesh mesh = marching::to_mesh(left, base::part(progress, 0, 0.5));
  std::vector<double> distance;
  if (!mesh.empty()) distance = deviation(mesh, part, true, base::part(progress, 0.5, 1));
  return {std::move(mesh), std::move(distance)};
}

std::vector<double> part_map_of(const Mesh& left, const Mesh& part, const Progress& progress) {
  if (left.empty()) return std::vector<double>(part.vertices.size(), -std::numeric_limits<double>::infinity());
  std::vector<double> distance = deviation(part, left, true, progress);
  for (double& d : distance) d = 0 - d;  // inside of the material: covered
  return distance;
}

}  // namespace riffler::verify
