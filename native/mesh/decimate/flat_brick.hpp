// Removes the vertices inside planes from one brick of a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Some triangles of a mesh with half-edges of their own, small enough for a core's cache.
///
/// The triangles form *flats*: sets of triangles joined by edges, with all vertices within `slack` of one plane and all
/// triangles facing to its side. A vertex inside a flat merges into a neighbour if all new triangles face to that side
/// too. Then old and new fan are heights over the same polygon of the plane, so no point moves along the flat's main
/// axis by more than 2 √3 times the flat's thickness, however many vertices go: see `moved`.
///
/// Vertices with triangles outside the brick stay, as do vertices at flats' edges and those whose fan is not one closed
/// disk. Reads and writes only its own triangles, so bricks can run in parallel.
class FlatBrick {
 public:
  /// `triangles` are those of `mesh` that belong to the brick; `uses` has the number of corners of the whole mesh at
  /// each vertex.
  FlatBrick(const Vertices& points, const Triangles& all, std::span<const int> triangles,
            std::span<const std::uint8_t> uses);

  /// Returns the number of triangles that vanish.
  std::size_t run(double slack);

  /// A side between two vertices that stay, of a triangle that may have got another tip.
  struct Side {
    int a, b;            // of the mesh
    Vec3 before, after;  // normal of its triangle, of any length
    bool changed;
  };
  /// After `run`: merges vertices of curves, too, with StarCollapser. Returns the largest distance in mm between the
  /// old and the new surface, in both directions, at most `tolerance`. Only the triangles of one brick are seen, so
  /// others may fold onto them: adds the sides where that is possible.
  double merge_stars(double tolerance, std::vector<Side>& sides);
  /// Writes the triangles back; those that vanished get -1.
  void store(Triangles& all) const;
  /// mm, the largest distance between a point of the old surface and its place on the new one, in both directions.
  double moved() const;

 private:
  struct Plane {
    Vec3 normal, point;
  };
  struct Flat {
    int x, y;          // the axes of its projection
    double thickness;  // largest distance of a vertex from the plane
  };

  void number(std::span<const std::uint8_t> uses);
  void join();
  void find_whole(std::span<const std::uint8_t> uses);
  void find_flats(double slack);
  bool grow(int seed, const Plane& plane, double slack);
  Plane fitted() const;
  void find_inner();
  bool winds_once(int v) const;
  bool remove(int v);
  bool gather(int v);
  double worst_if_to(std::size_t target) const;
  bool keeps_edges_single(std::size_t target);
  bool has_neighbour(int v, int other) const;
  void merge(std::size_t target);

  bool gone(int t) const { return start_[3 * static_cast<std::size_t>(t)] < 0; }
  std::array<Vec3, 3> corners(int t) const;

  std::span<const int> triangles_;      // in the mesh
  std::vector<int> start_, twin_;       // of each half-edge: the vertex where it starts; the one across, or -1
  std::vector<int> vertex_;             // of the mesh
  std::vector<Vec3> point_;             // of each vertex
  std::vector<int> out_;                // of each vertex: a half-edge that starts there
  std::vector<char> whole_;             // of each vertex: all its triangles are here and form one closed disk
  std::vector<int> flat_of_, flat_at_;  // of each triangle; of each vertex, or -1 at a flat's edge
  std::vector<int> touched_, mark_;     // of each vertex: the last round and the last collapse that met it
  std::vector<Flat> flats_;
  // of the flat that grows
  std::vector<int> grown_, seen_;
  double thickness_ = 0;
  // of the vertex that may go: half-edges from it, and their ends
  std::vector<int> spoke_, ring_;
  Flat flat_{};
  double worst_now_ = 0, moved_ = 0;
  int round_ = 0, stamp_ = 0;
};

}  // namespace riffler::mesh
