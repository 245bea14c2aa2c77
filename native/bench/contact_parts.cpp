#include "bench/contact_parts.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <stdexcept>

#include "geom/math.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/mesh/io/io.hpp"
#include "riffler/plan/pencil.hpp"

namespace riffler::bench {

namespace {

constexpr double kTubeRadius = kBoreRadius, kTubeHeight = 60;  // mm, of bore and prism
constexpr double kDeep = 0.3, kAbove = 2;                      // mm

class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : bits_(seed) {}
  double operator()(double from, double to) {
    return from + static_cast<double>(bits_() >> 11) * 0x1p-53 * (to - from);
  }

  /// A random direction within `most` (rad) of `axis`.
  Vec3 near(const Vec3& axis, double most) {
    const Vec3 u = geom::any_perpendicular(axis), v = glm::cross(axis, u);
    const double tilt = (*this)(0, most), way = (*this)(0, 2 * kPi);
    return glm::normalize(std::cos(tilt) * axis + std::sin(tilt) * (std::cos(way) * u + std::sin(way) * v));
  }

 private:
  std::mt19937_64 bits_;
};

/// The side of a cylinder about z in `rows` rows of squares; normals away from the axis, or towards it for a bore.
Mesh tube(int sides, int rows, bool bore) {
  Mesh out;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < sides; ++i) {
      const double a = 2 * kPi * i / sides;
      out.vertices.push_back({kTubeRadius * std::cos(a), kTubeRadius * std::sin(a), kTubeHeight * j / rows});
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < sides; ++i) {
      const int p = j * sides + i, q = j * sides + (i + 1) % sides;
      if (bore)
        out.triangles.push_back({p, q + sides, q}), out.triangles.push_back({p, p + sides, q + sides});
      else
        out.triangles.push_back({p, q, q + sides}), out.triangles.push_back({p, q + sides, p + sides});
    }
  return out;
}

Mesh capped(Mesh tube, int sides) {
  for (int i = 1; i + 1 < sides; ++i)
    tube.triangles.push_back({0, i + 1, i}), tube.triangles.push_back({sides, sides + i, sides + i + 1});
  return tube;
}

Mesh box() {
  Mesh out;
  for (int k = 0; k < 8; ++k) out.vertices.push_back({60.0 * (k & 1), 40.0 * (k >> 1 & 1), 30.0 * (k >> 2)});
  for (const Vec3i& t : {Vec3i(0, 2, 1),
                         {1, 2, 3},
                         {4, 5, 6},
                         {5, 7, 6},
                         {0, 1, 4},
                         {1, 5, 4},
                         {2, 6, 3},
                         {3, 6, 7},
                         {0, 4, 2},
                         {2, 4, 6},
                         {1, 3, 5},
                         {3, 7, 5}})
    out.triangles.push_back(t);
  return out;
}

/// A wavy sheet of strips.
Mesh needles() {
  constexpr int kStrips = 4000;
  Mesh out;
  for (int i = 0; i <= kStrips; ++i)
    for (const double y : {0.0, 60.0}) out.vertices.push_back({0.01 * i, y, 1.5 * std::sin(0.4 * 0.01 * i)});
  for (int i = 0; i < 2 * kStrips; i += 2)
    out.triangles.push_back({i, i + 2, i + 3}), out.triangles.push_back({i, i + 3, i + 1});
  return out;
}

/// Poses on the paths of a ball, uniformly by stations.
std::vector<Pose> in_valleys(const Mesh& mesh, const Tool& tool, int count, Uniform& uniform) {
  std::vector<Pose> out;
  const double r = 0.5 * tool.diameter();
  const plan::PencilResult found = plan::pencil(mesh, r);
  std::vector<std::pair<const plan::PencilPath*, std::size_t>> stations;
  for (const plan::PencilPath& path : found.paths)
    for (std::size_t k = 0; k < path.centres.size(); ++k) stations.emplace_back(&path, k);
  if (stations.empty()) return out;
  for (int k = 0; k < count; ++k) {
    const auto last = static_cast<double>(stations.size()) - 1e-9;
    const auto& [path, at] = stations[static_cast<std::size_t>(uniform(0, last))];
    const Vec3& centre = path->centres[at];
    const Vec3 out_of = 2.0 * centre - path->contacts[at][0] - path->contacts[at][1];
    const Vec3 middle = glm::length(out_of) > 1e-3 * r ? glm::normalize(out_of) : path->normals[at][0];
    const Vec3 axis = uniform.near(middle, kPi / 9);
    out.push_back({centre - r * axis - uniform(0, kDeep) * middle, axis});
  }
  return out;
}

/// Poses at places spread evenly over the surface, the ball's side or end towards it.
std::vector<Pose> on_surface(const Mesh& mesh, const Tool& tool, int count, bool along_z, Uniform& uniform) {
  std::vector<double> sums;
  for (const Vec3i& t : mesh.triangles)
    sums.push_back((sums.empty() ? 0 : sums.back()) + glm::length(glm::cross(mesh.vertices[t.y] - mesh.vertices[t.x],
                                                                             mesh.vertices[t.z] - mesh.vertices[t.x])));
  std::vector<Pose> out;
  const double r = 0.5 * tool.diameter();
  while (static_cast<int>(out.size()) < count) {
    const auto place = std::lower_bound(sums.begin(), sums.end(), uniform(0, sums.back())) - sums.begin();
    const Vec3i& t = mesh.triangles[static_cast<std::size_t>(place)];
    const Vec3 &a = mesh.vertices[t.x], &b = mesh.vertices[t.y], &c = mesh.vertices[t.z];
    double u = uniform(0, 1), v = uniform(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3 n = glm::cross(b - a, c - a);
    if (!(glm::length(n) > 0)) continue;
    const Vec3 normal = glm::normalize(n), axis = along_z ? Vec3(0, 0, 1) : uniform.near(normal, kPi / 4);
    const double above = along_z ? uniform(-kDeep, 0) : uniform(-kDeep, kAbove);
    out.push_back({a + u * (b - a) + v * (c - a) + (r + above) * normal - r * axis, axis});
  }
  return out;
}

}  // namespace

const std::vector<std::string>& contact_part_names() {
  static const std::vector<std::string> kNames{"bore", "wall", "box", "prism", "needles"};
  return kNames;
}

Mesh contact_mesh(const std::string& name) {
  if (name == "bore" || name == "wall") return tube(360, name == "bore" ? 1 : 40, true);
  if (name == "prism") return capped(tube(32, 1, false), 32);
  if (name == "box") return box();
  if (name == "needles") return needles();
  if (std::filesystem::exists(name)) return mesh::read_mesh(name);
  throw std::invalid_argument("part: \"" + name + "\" is neither a part's name nor a file");
}

ContactPart contact_part(const std::string& name, const Tool& tool, int count, std::uint64_t seed) {
  ContactPart out{contact_mesh(name), {}};
  const bool along_z = name == "bore" || name == "wall";
  Uniform uniform(seed);
  const collide::Collider collider(out.mesh);
  const collide::Assembly assembly(tool);
  const auto take = [&](const std::vector<Pose>& from, int most) {
    for (const Pose& pose : from)
      if (most > 0 && collider.keeps(assembly, pose, -1.001 * kDeep)) out.poses.push_back(pose), --most;
  };
  if (std::filesystem::exists(name)) take(in_valleys(out.mesh, tool, 4 * count, uniform), count / 2);
  take(on_surface(out.mesh, tool, 20 * count, along_z, uniform), count - static_cast<int>(out.poses.size()));
  if (static_cast<int>(out.poses.size()) < count)
    throw std::invalid_argument("part: only " + std::to_string(out.poses.size()) + " of the poses drawn are at most " +
                                std::to_string(kDeep) + " mm deep");
  return out;
}

}  // namespace riffler::bench
