// What the simplification of one group of vertices reads and what it leaves.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "base/mix.hpp"
#include "base/sort_unique.hpp"
#include "marching/vertex_groups.hpp"
#include "mesh/decimate/star_collapse.hpp"

namespace riffler::marching {

/// 128 bits of a hash. Equal digests stand for equal data.
struct Digest {
  std::uint64_t low = 0x243f6a8885a308d3, high = 0x13198a2e03707344;

  void add(std::uint64_t x) {
    low = std::rotl((low ^ x) * 0x9e3779b97f4a7c15, 29) + 0x452821e638d01377;
    high = std::rotl((high + x) * 0xd6e8feb86659fd93, 37) ^ low;
  }
  void add(const Vec3& p) {
    for (int a = 0; a < 3; ++a) add(std::bit_cast<std::uint64_t>(p[a]));
  }
  void finish() { low = base::mix_bits(low ^ std::rotl(high, 32)), high = base::mix_bits(high + low); }
  bool operator==(const Digest&) const = default;
};

/// Names a vertex by its brick, relative to another, and its number within it: in ascending order of such names the
/// vertices of a brick's surroundings come in the order of a new mesh, wherever their bricks are stored.
class VertexName {
 public:
  /// Names no vertex.
  VertexName() = default;
  /// `offset`: of the vertex's brick, −1 … 1 along each axis.
  VertexName(const Vec3i& offset, std::size_t local)
      : bits_(static_cast<std::uint32_t>(place_of(offset)) << kLocalBits | static_cast<std::uint32_t>(local)) {}

  Vec3i offset() const { return {place() / 9 - 1, place() / 3 % 3 - 1, place() % 3 - 1}; }
  std::size_t local() const { return bits_ & ((1U << kLocalBits) - 1); }
  /// The bit of the vertex's brick among the 27.
  std::uint32_t brick_bit() const { return std::uint32_t{1} << place(); }
  /// The same vertex, relative to a brick at `by` of this one.
  VertexName seen_from(const Vec3i& by) const { return {offset() - by, local()}; }
  auto operator<=>(const VertexName&) const = default;

  static int place_of(const Vec3i& offset) { return (offset.x + 1) * 9 + (offset.y + 1) * 3 + offset.z + 1; }

 private:
  // A brick has at most four vertices in each of its 32³ cells.
  static constexpr int kLocalBits = 17;
  int place() const { return static_cast<int>(bits_ >> kLocalBits); }

  std::uint32_t bits_ = ~std::uint32_t{0};
};

/// Numbers the vertices of triangles from 0 in the order of their names. Triangles next to each other in a list have
/// most vertices in common, so the last few are looked at first.
class VertexNumbers {
 public:
  /// `names`: filled by add() and finish().
  explicit VertexNumbers(std::vector<VertexName>& names) : names_(names) {}

  void add(const VertexName& v) {
    if (std::find(recent_.begin(), recent_.end(), v) != recent_.end()) return;
    remember(v);
    names_.push_back(v);
  }
  /// Call it after the last add() and before the first of().
  void finish() {
    base::sort_unique(names_);
    recent_.fill(VertexName());
  }
  /// The number of a name that was added.
  std::int32_t of(const VertexName& v) {
    const auto found = std::find(recent_.begin(), recent_.end(), v);
    if (found != recent_.end()) return number_[found - recent_.begin()];
    const auto number = static_cast<std::int32_t>(std::lower_bound(names_.begin(), names_.end(), v) - names_.begin());
    number_[next_] = number;
    remember(v);
    return number;
  }

 private:
  void remember(const VertexName& v) { recent_[next_] = v, next_ = (next_ + 1) % recent_.size(); }

  std::vector<VertexName>& names_;
  std::array<VertexName, 4> recent_{};
  std::array<std::int32_t, 4> number_{};
  std::size_t next_ = 0;
};

/// A triangle near a border between bricks. Its vertices are named relative to the triangle's brick.
struct BorderFace {
  std::array<VertexName, 3> v;
  float error;
  bool removed;
  bool operator==(const BorderFace&) const = default;
};

/// The triangles around a group, with vertices numbered from 0 in the order of their names.
struct GroupInput {
  mesh::Vertices vertices;
  mesh::Triangles triangles;  // −1: removed
  base::BulkVector<float> errors;
  std::vector<VertexName> names;         // of the vertices, relative to the group's brick; ascending
  std::vector<BorderFace> faces;         // the triangles of a border, for its gathering only
  std::vector<std::uint8_t> movable;     // the vertices that belong to the group and are not fixed
  std::array<std::uint32_t, 9> begin{};  // of the triangles by side of their brick
  Digest digest;

  void clear();
  void hash();
  /// Merges vertices of the group. The triangles and errors change.
  void simplify(mesh::StarCollapser& collapser, int group);
};

/// What the simplification of a group left; of group 0, which is the last to change its triangles, the final triangles.
/// It depends on its input only, so it is kept as long as the input stays the same.
struct GroupResult {
  Digest made_from;                   // its input's
  std::vector<std::uint32_t> places;  // of the vertices that are left, in the input
  std::vector<VertexName> names;      // their names
  std::uint32_t bricks = 0;           // bits of the 27 bricks of the input's vertices
  mesh::Triangles triangles;          // −1: removed; of group 0 none is
  std::vector<float> errors;          // of each triangle, but for group 0
  std::array<std::uint32_t, 9> begin{};
  // For group 0 only:
  Digest patch;  // of the corners' positions
  struct Rim {
    std::int32_t lower, upper;
    std::uint32_t triangle;
    auto operator<=>(const Rim&) const = default;
  };
  std::vector<Rim> rim;               // the sides without a neighbour in the brick, ascending
  std::vector<std::uint32_t> folded;  // triangles that lie on another one of the brick

  /// `compact`: leave the removed triangles out.
  static GroupResult of(const GroupInput& input, bool compact);
  /// The same for an input that differs in its names only.
  GroupResult renamed(const GroupInput& input) const;
  std::array<VertexName, 3> corners(std::size_t t) const {
    const Vec3i& v = triangles[t];
    return {names[v.x], names[v.y], names[v.z]};
  }
  /// Whether two results leave the same triangles in the brick at a side, by names.
  bool same_at(int side, const GroupResult& other) const;

 private:
  void find_rim(const GroupInput& input);
};

/// Whether two triangles with a common side lie on each other.
bool lie_on(const mesh::Vertices& vertices, const Vec3i& one, const Vec3i& other);

}  // namespace riffler::marching
