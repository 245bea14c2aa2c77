#include "riffler/mesh/mesh.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

constexpr double kLargest = 1e30;  // beyond it, cubes of coordinates overflow double
constexpr std::size_t kSumGrain = 1 << 15;

/// Sum of term(t) over all triangles, grouped in fixed chunks, so it does not depend on the number of threads.
template <class Term>
double sum_over_triangles(const Mesh& mesh, const Term& term) {
  const std::size_t n = mesh.triangles.size();
  std::vector<double> parts((n + kSumGrain - 1) / kSumGrain, 0.0);
  base::parallel_for(n, kSumGrain, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t t = begin; t < end; ++t) sum += term(mesh.triangles[t]);
    parts[begin / kSumGrain] = sum;
  });
  double sum = 0;
  for (const double part : parts) sum += part;
  return sum;
}

}  // namespace

void validate(const Mesh& mesh) {
  const auto in_range = [](const Vec3& v) {
    // in this form, NaN fails
    return std::abs(v.x) <= kLargest && std::abs(v.y) <= kLargest && std::abs(v.z) <= kLargest;
  };
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!in_range(mesh.vertices[i]))
      throw std::invalid_argument("vertices, row " + std::to_string(i) +
                                  (geom::finite(mesh.vertices[i]) ? ": beyond 1e30" : ": not finite"));
  const auto n = static_cast<std::int64_t>(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (const int v = mesh.triangles[t][k]; v < 0 || v >= n)
        throw std::invalid_argument("triangles, row " + std::to_string(t) + ": no vertex " + std::to_string(v) +
                                    ": there are " + std::to_string(n) + ", counted from 0");
}

double volume(const Mesh& mesh) {
  if (mesh.empty()) return 0;
  // About the centre: far from the origin, the tetrahedra to it would be huge and cancel.
  const Box3 box = bounds(mesh);
  const Vec3 centre = box.lower + 0.5 * (box.upper - box.lower);
  return sum_over_triangles(mesh,
                            [&](const Vec3i& t) {
                              const Vec3 a = mesh.vertices[t.x] - centre, b = mesh.vertices[t.y] - centre,
                                         c = mesh.vertices[t.z] - centre;
                              return glm::dot(a, glm::cross(b, c));
                            }) /
         6;
}

double area(const Mesh& mesh) {
  return sum_over_triangles(mesh,
                            [&](const Vec3i& t) {
                              const Vec3& a = mesh.vertices[t.x];
                              return glm::length(glm::cross(mesh.vertices[t.y] - a, mesh.vertices[t.z] - a));
                            }) /
         2;
}

Box3 bounds(const Mesh& mesh) {
  const std::size_t n = mesh.triangles.size();
  std::vector<Box3> parts((n + kSumGrain - 1) / kSumGrain);
  base::parallel_for(n, kSumGrain, [&](std::size_t begin, std::size_t end) {
    Box3 box;
    for (std::size_t t = begin; t < end; ++t)
      for (int k = 0; k < 3; ++k) box.add(mesh.vertices[mesh.triangles[t][k]]);
    parts[begin / kSumGrain] = box;
  });
  Box3 box;
  for (const Box3& part : parts) box.add(part);
  return box;
}

}  // namespace riffler::mesh
