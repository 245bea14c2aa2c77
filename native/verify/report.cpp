#include "riffler/verify/report.hpp"

#include <limits>
#include <string>

#include "mesh/closest.hpp"
#include "riffler/marching/to_mesh.hpp"

namespace riffler::verify {

const char* name_of(Kind kind) {
  static constexpr const char* names[] = {"rapid", "holder",  "shank",   "fixture", "gouge",
                                          "rest",  "spindle", "machine", "unknown"};
  return names[static_cast<int>(kind)];
}

VerifyStats& VerifyStats::operator+=(const VerifyStats& o) {
  moves += o.moves, slabs += o.slabs, slabs_kept += o.slabs_kept, snapshots_used += o.snapshots_used;
  probes += o.probes, probed_moves += o.probed_moves, bisections += o.bisections, skipped += o.skipped;
  return *this;
}

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
  for (double& d : distance) d = 0 - d;  // inside the material: covered
  return distance;
}

}  // namespace riffler::verify
