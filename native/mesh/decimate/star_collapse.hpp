// Removes vertices of a mesh one at a time, and keeps the surface within a proven distance of the first one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// A mesh whose triangles lose vertices. A removed triangle has −1 for all its vertices.
struct AdaptiveMesh {
  const Vertices& vertices;
  Triangles& triangles;
  /// For each triangle, mm: an upper bound of the distance of its points from their points on the first surface.
  base::BulkVector<float>& errors;
};

/// Merges vertices of one group into others of the group, which do not move. The triangles around the group's vertices
/// are copied first, so that the work stays in the inner caches.
///
/// The bound. A merge replaces the triangles around a vertex by others with the same border. It is allowed only if one
/// direction exists along which all old and all new triangles face outward: then both are graphs over one polygon, and
/// moving each point along that direction maps one onto the other, in both directions. The distance of the two graphs
/// is linear between the points where their edges cross, so its maximum is found exactly, and the bounds of the merges
/// add up. The composition of all these maps takes the first surface onto the last and back.
///
/// The topology. A merge is allowed only if the two vertices have exactly two common neighbours (the link condition),
/// so a two-manifold stays one of the same genus. Every new edge starts at a vertex of the group, whose triangles only
/// this group changes: groups without a common triangle may be processed in parallel and in any order.
class StarCollapser {
 public:
  enum class Effort {
    Full,
    Quick,  // leaves more triangles, and flat blocks to the caller
  };
  /// `tolerance`: mm, > 0.
  StarCollapser(const AdaptiveMesh& mesh, double tolerance, Effort effort = Effort::Full)
      : mesh_(mesh), tolerance_(tolerance), effort_(effort) {}

  /// The triangles around each vertex of a group must form one closed disc that winds around it once.
  ///
  /// Starts a group: vertices first … first + count − 1 with `in_group(vertex)`. It may use `share` of the tolerance.
  template <class InGroup>
  void begin(std::int32_t first, std::size_t count, double share, InGroup&& in_group) {
    most_error_ = share * tolerance_, wide_ = share == 1;
    first_ = first;
    slot_.assign(count, kForeign);
    for (std::size_t v = 0; v < count; ++v)
      if (in_group(first + static_cast<std::int32_t>(v))) slot_[v] = kUnseen;
    stamp_ = 0;
    stars_.clear(), faces_.clear(), around_.clear();
  }
  /// Adds a triangle that may have a vertex of the group; each at most once.
  void add(std::uint32_t triangle);
  /// Merges what can be merged, and writes the triangles back.
  void run();

 private:
  static constexpr std::int32_t kForeign = -2, kUnseen = -1;
  static constexpr int kMostFaces = 80;
  // All old and new triangles are within 60° of the common direction, and a triangle turns by at most 32°, so that
  // sharp edges stay and no two triangles fold onto each other.
  static constexpr double kFacing = 0.5, kTurn = 0.85;
  // Cosine of 68.2°. A new triangle that folds onto its neighbour, by over 168.5°, is within 31.8° of the old one on
  // its side, so the old one and the neighbour were over 136.7° apart, and one of them 68.3° from any direction.
  static constexpr double kCalm = 0.371;
  // Least height of a new triangle over its longest side: enough for a reliable normal.
  static constexpr double kThinnest = 2e-3;

  static float rounded_up(double x);

  struct Face {
    Vec3i v;
    std::uint32_t triangle;
    Vec3 normal;  // unit
    float error;
    std::int32_t stamp;  // the last block that it was seen in
  };
  /// A vertex of the group and the faces around it.
  struct Star {
    std::int32_t vertex;
    std::uint8_t count;  // 0: merged into another
    bool locked;         // has more faces than there is room for
    bool queued;
    bool calm;           // all faces around it, also earlier ones, faced within kCalm of the first one
    std::int32_t stamp;  // the last block that it belonged to
    double needs;        // lower bound of the error of its next merge, mm
    Vec3 facing;         // normal of the first face
  };
  /// A face around the vertex that is to go: the edge opposite to it, from a to b, relative to the vertex.
  struct Side {
    std::int32_t a, b;
    Vec3 pa, pb;
    Vec3 normal;
    double height;  // of a, along the common direction
  };
  struct Target {
    double guess;  // of the error
    int side;      // its a is the vertex to merge into
  };

  std::int32_t slot(std::int32_t v) const {
    const std::size_t local = static_cast<std::size_t>(static_cast<std::int64_t>(v) - first_);
    return local < slot_.size() ? slot_[local] : kForeign;
  }
  std::int32_t* around(std::int32_t s) { return around_.data() + static_cast<std::ptrdiff_t>(s) * kMostFaces; }
  const std::int32_t* around(std::int32_t s) const {
    return around_.data() + static_cast<std::ptrdiff_t>(s) * kMostFaces;
  }
  std::int32_t seen(std::int32_t v);
  bool is_calm(std::int32_t s) const { return s >= 0 && !stars_[s].locked && stars_[s].calm; }
  /// Takes the normal of a face that is added to a star; s may be none.
  void see_normal(std::int32_t s, const Vec3& normal) {
    if (s >= 0 && !(glm::dot(stars_[s].facing, normal) > kCalm)) stars_[s].calm = false;
  }
  bool gather(std::int32_t from, double limit);
  bool merge(std::int32_t from, double limit, int most_faces);
  struct Flat {
    Vec3 direction;
    double slab, error;
  };
  void flatten(std::int32_t* begin, std::int32_t* end);
  bool is_flat(const std::int32_t* begin, const std::int32_t* end, Flat& flat);
  bool find_rim(const std::int32_t* begin, const std::int32_t* end);
  bool fits_rim() const;
  bool fan(const std::int32_t* begin, const std::int32_t* end, const Flat& flat);
  bool keeps_manifold(std::int32_t from, std::int32_t to, std::int32_t x, std::int32_t y) const;
  bool keeps_shape(const Side& to);
  bool folds(std::int32_t from, const Side& to) const;
  void turn_ring();
  double error_of(const Side& to, double enough);
  void commit(std::int32_t from, std::int32_t to, double error, double limit);
  void drop(std::int32_t vertex, std::int32_t face);
  void spread();
  void sweep(double limit, int most_faces);

  AdaptiveMesh mesh_;
  double tolerance_;
  Effort effort_;
  double most_error_ = 0;  // of this group
  bool wide_ = false;      // the group fills an area: look for flat blocks
  std::int32_t first_ = 0;
  std::vector<std::int32_t> slot_;  // of the vertices from first_ on
  std::vector<Star> stars_;
  base::BulkVector<std::int32_t> around_;  // kMostFaces places for each star
  std::vector<Face> faces_;
  std::vector<std::int32_t> order_, queue_;
  // The block of flat triangles under examination:
  struct RimEdge {
    std::int32_t a, b;
    bool operator<(const RimEdge& o) const { return a < o.a; }
  };
  std::vector<std::int32_t> block_;
  std::vector<std::int32_t> inside_;  // its faces
  std::vector<RimEdge> rim_;          // of the block, by a
  std::int32_t stamp_ = 0;
  // The vertex under examination:
  std::array<Side, kMostFaces> sides_;
  int count_ = 0;
  Vec3 direction_{0};
  double base_ = 0, slab_ = 0;
  double least_ = 0;  // lower bound of the error of any merge
  // The vertices around it in the frame of the direction, twice; the third coordinate is the height.
  std::array<Vec3, 2 * kMostFaces> ring_;
  std::array<int, kMostFaces> place_in_ring_;  // of the start of each side
  bool has_ring_ = false;
};

}  // namespace riffler::mesh
