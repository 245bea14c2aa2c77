#include "collide/surface.hpp"

#include <algorithm>
#include <cmath>

#include "collide/pieces.hpp"

namespace riffler::collide {

namespace {

double longest_edge(const Corners& c) {
  return std::max({glm::length(c.b - c.a), glm::length(c.c - c.b), glm::length(c.a - c.c)});
}

Corners corners_of(const Mesh& mesh, const Vec3i& t) {
  return {mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]};
}

/// About as many pieces as long triangles become, if none may be longer than `most`.
std::size_t pieces(const Mesh& mesh, double most) {
  double out = 0;
  for (const Vec3i& t : mesh.triangles) out += std::ceil(longest_edge(corners_of(mesh, t)) / most);
  return static_cast<std::size_t>(std::min(out, 1e15));
}

}  // namespace

bool is_longer(const Mesh& mesh, double most) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const Vec3i& t) { return longest_edge(corners_of(mesh, t)) > most; });
}

Mesh divided(const Mesh& mesh, double most) {
  while (pieces(mesh, 4 * most) > 2 * mesh.triangles.size() + kMorePieces) most *= 2;
  Mesh out;
  for (const Vec3i& t : mesh.triangles)
    cut_into_pieces(Piece(corners_of(mesh, t)), most, 0.25 * most * most, 4 * most, [&](const Piece& piece) {
      const int first = static_cast<int>(out.vertices.size());
      out.vertices.insert(out.vertices.end(), piece.points().begin(), piece.points().end());
      for (int k = 2; k < static_cast<int>(piece.points().size()); ++k)
        out.triangles.emplace_back(first, first + k - 1, first + k);
    });
  return out;
}

std::vector<Corners> Surface::corners_of(const Mesh& mesh) {
  std::vector<Corners> out(mesh.triangles.size());
  for (std::size_t t = 0; t < out.size(); ++t) out[t] = collide::corners_of(mesh, mesh.triangles[t]);
  return out;
}

Surface::Surface(const std::vector<Corners>& corners, const std::vector<double>& chords)
    : tree_({corners.size(),
             [&](std::size_t t) {
               Box3 box;
               box.add(corners[t].a), box.add(corners[t].b), box.add(corners[t].c);
               return box;
             },
             [&](std::size_t t) {
               BoundingSphere sphere = round_triangle(corners[t].a, corners[t].b, corners[t].c);
               if (!chords.empty()) sphere.radius += chords[t];
               return sphere;
             },
             [&](std::size_t t, const Vec3& p) {
               const Corners& c = corners[t];
               return std::max({glm::length(c.a - p), glm::length(c.b - p), glm::length(c.c - p)}) +
                      (chords.empty() ? 0 : chords[t]);
             }}) {
  corners_.reserve(corners.size() + base::kLanes);
  for (const std::uint32_t t : tree_.order()) corners_.push_back(corners[t]);
  if (!chords.empty()) {
    chords_.reserve(corners.size() + base::kLanes);
    for (const std::uint32_t t : tree_.order()) chords_.push_back(chords[t]);
    max_chord_ = *std::max_element(chords.begin(), chords.end());
  }
  boxes_ = oriented_boxes(tree_, corners_, chords_);
  corners_.resize(corners.size() + base::kLanes, {Vec3(0), Vec3(0), Vec3(0)});
  if (!chords.empty()) chords_.resize(chords.size() + base::kLanes, 0);
}

namespace {

std::vector<Corners> corners_of(const nurbs::ExactTriangles& exact) {
  std::vector<Corners> out(exact.triangles.size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    const nurbs::ExactTriangle& e = exact.triangles[t];
    out[t] = {exact.point(e.cell, e.uv[0]), exact.point(e.cell, e.uv[1]), exact.point(e.cell, e.uv[2])};
  }
  return out;
}

std::vector<double> chords_of(const nurbs::ExactTriangles& exact) {
  constexpr double kRounding = 1e-12;  // mm: and of evaluation, relative to the size
  std::vector<double> out;
  for (const nurbs::ExactTriangle& e : exact.triangles)
    out.push_back(exact.chord(e.cell, e.uv[0], e.uv[1], e.uv[2]) + kRounding);
  return out;
}

}  // namespace

Surface::Surface(const nurbs::ExactTriangles& exact) : Surface(collide::corners_of(exact), chords_of(exact)) {
  exact_ = &exact;
}

}  // namespace riffler::collide
