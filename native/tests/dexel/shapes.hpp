// Meshes and references that the tests of mesh → volume share. Nothing here uses the code under test.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "geom/math.hpp"
#include "mesh/solids.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::shapes {

/// A box without its lid (the two triangles at the upper z).
inline Mesh open_box(const Vec3& lower, const Vec3& upper) {
  Mesh m = box(lower, upper);
  m.triangles.erase(m.triangles.begin() + 2, m.triangles.begin() + 4);
  return m;
}

/// Sphere of `rings` × 2 `rings` facets about `centre`, vertices on the radius.
inline Mesh sphere(const Vec3& centre, double radius, int rings) {
  Mesh m;
  m.vertices.push_back(centre + Vec3(0, 0, radius));
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      const double a = kPi * i / rings, b = kPi * j / rings;
      m.vertices.push_back(centre + radius * Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
    }
  m.vertices.push_back(centre - Vec3(0, 0, radius));
  const int last = static_cast<int>(m.vertices.size()) - 1;
  const auto id = [&](int i, int j) {
    return i == 0 ? 0 : i == rings ? last : 1 + (i - 1) * 2 * rings + j % (2 * rings);
  };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) m.triangles.emplace_back(id(i, j), id(i + 1, j), id(i, j + 1));
      if (i < rings - 1) m.triangles.emplace_back(id(i, j + 1), id(i + 1, j), id(i + 1, j + 1));
    }
  return m;
}

inline Mesh moved(Mesh m, const Mat3& turn, const Vec3& shift) {
  for (Vec3& p : m.vertices) p = turn * p + shift;
  return m;
}

inline Mat3 rotation(const Vec3& axis, double angle) {
  const Vec3 u = glm::normalize(axis);
  const double c = std::cos(angle), s = std::sin(angle);
  Mat3 r(0);
  for (int k = 0; k < 3; ++k) {
    Vec3 e(0);
    e[k] = 1;
    r[k] = c * e + s * glm::cross(u, e) + (1 - c) * glm::dot(u, e) * u;
  }
  return r;
}

inline Box3 box_of(const Mesh& m) {
  Box3 b;
  for (const Vec3& p : m.vertices) b.add(p);
  return b;
}

/// The divergence theorem in long double about a vertex: a closed mesh's signed volume.
inline double signed_volume(const Mesh& m) {
  const Vec3 o = m.vertices.at(0);
  long double six = 0;
  for (const Vec3i& t : m.triangles)
    six += glm::dot(m.vertices[t.x] - o, glm::cross(m.vertices[t.y] - o, m.vertices[t.z] - o));
  return static_cast<double>(six / 6);
}

/// Generalized winding number: the sum of the solid angles of all triangles over 4π (Jacobson et al., "Robust
/// Inside-Outside Segmentation Using Generalized Winding Numbers", SIGGRAPH 2013, equation 6).
inline double winding_number(const Mesh& m, const Vec3& p) {
  double sum = 0;
  for (const Vec3i& t : m.triangles) {
    const Vec3 a = m.vertices[t.x] - p, b = m.vertices[t.y] - p, c = m.vertices[t.z] - p;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += std::atan2(glm::dot(a, glm::cross(b, c)),
                      la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (2 * kPi);
}

inline bool inside(const dexel::Grid& grid, int i, int j, double z) {
  for (const dexel::Span& s : grid.ray(i, j))
    if (z > s.near && z < s.far) return true;
  return false;
}

struct Agreement {
  int tested = 0, different = 0;
  double worst = 0;  // | |w| − ½ | of points that differ
};

/// Points on rays, half of them near span ends.
inline Agreement compare(const Mesh& mesh, const Volume& volume, int points, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Agreement result;
  for (const dexel::Grid& grid : volume.grids()) {
    std::uniform_real_distribution<double> along(grid.box().lower.z, grid.box().upper.z);
    for (int k = 0; k < points; ++k) {
      const int i = static_cast<int>(random() % grid.nu()), j = static_cast<int>(random() % grid.nv());
      double z = along(random);
      const auto spans = grid.ray(i, j);
      if (k % 2 == 1 && !spans.empty()) {
        const dexel::Span& s = spans[random() % spans.size()];
        z = (random() % 2 == 0 ? s.near : s.far) + (random() % 2 == 0 ? 1e-2 : -1e-2) * grid.pitch();
      }
      // Off the ray as the half-open rule has it: walls may stand exactly on rays.
      const Vec3 p = to_world(grid.axis(), Vec3(grid.u(i) + 1e-9, grid.v(j) + 1e-8, z));
      const double w = std::abs(winding_number(mesh, p));
      if (std::abs(w - 0.5) < 1e-6) continue;  // a tie, such as everywhere in the plane of a flat opening
      ++result.tested;
      if (inside(grid, i, j, z) == (w > 0.5)) continue;
      ++result.different, result.worst = std::max(result.worst, std::abs(w - 0.5));
    }
  }
  return result;
}

/// RIFFLER_MODELS, or else shared/models next to the repository, sought from the working directory upwards.
inline std::filesystem::path model_path(const std::string& name) {
  std::filesystem::path models = "../shared/models";
  if (const char* folder = std::getenv("RIFFLER_MODELS")) {
    models = folder;
  } else {
    for (auto p = std::filesystem::current_path(); p != p.root_path(); p = p.parent_path())
      if (std::filesystem::is_directory(p / "shared/models")) {
        models = p / "shared/models";
        break;
      }
  }
  return models / (name + ".stl");
}

/// A binary STL, equal vertices welded; empty where the file is absent.
inline Mesh read_model(const std::string& name) {
  std::ifstream file(model_path(name), std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  Mesh m;
  std::map<std::array<float, 3>, int> ids;
  for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50) {
    std::array<std::array<float, 3>, 3> corners;
    std::memcpy(corners.data(), bytes.data() + at + 12, 36);
    Vec3i t;
    for (int k = 0; k < 3; ++k) {
      const auto [place, fresh] = ids.try_emplace(corners[k], static_cast<int>(m.vertices.size()));
      if (fresh) m.vertices.emplace_back(corners[k][0], corners[k][1], corners[k][2]);
      t[k] = place->second;
    }
    m.triangles.push_back(t);
  }
  return m;
}

/// A frame of `cells` along the longest side of the mesh's box, grown by `around` cells.
inline dexel::Frame frame_of(const Mesh& m, int cells, const std::string& directions, double around = 0) {
  const Box3 b = box_of(m);
  const Vec3 size = b.size();
  const double pitch = std::max({size.x, size.y, size.z}) / cells;
  return {b.grown(around * pitch), pitch, directions};
}

}  // namespace riffler::shapes
