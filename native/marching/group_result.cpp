#include "marching/group_result.hpp"

#include <algorithm>

namespace riffler::marching {

void GroupInput::clear() {
  vertices.clear(), triangles.clear(), errors.clear(), names.clear(), movable.clear(), faces.clear();
  begin = {};
}

void GroupInput::hash() {
  digest = {};
  for (const std::uint32_t n : begin) digest.add(n);
  digest.add(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) digest.add(vertices[v]);
  for (std::size_t v = 0; v < movable.size(); v += 64) {
    std::uint64_t bits = 0;
    for (std::size_t n = v; n < std::min(v + 64, movable.size()); ++n) bits |= std::uint64_t{movable[n]} << (n - v);
    digest.add(bits);
  }
  for (const Vec3i& t : triangles) {
    // Each number is less than 2²¹; −1 becomes its largest value.
    const auto bits = [](std::int32_t v) { return static_cast<std::uint64_t>(v) & 0x1fffff; };
    digest.add(bits(t.x) | bits(t.y) << 21 | bits(t.z) << 42);
  }
  for (const float e : errors) digest.add(std::bit_cast<std::uint32_t>(e));
  digest.finish();
}

void GroupInput::simplify(mesh::StarCollapser& collapser, int group) {
  collapser.begin(0, vertices.size(), share_of(group),
                  [&](std::int32_t v) { return movable[static_cast<std::size_t>(v)] != 0; });
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (triangles[t].x >= 0) collapser.add(static_cast<std::uint32_t>(t));
  collapser.run();
}

GroupResult GroupResult::of(const GroupInput& input, bool compact) {
  GroupResult out;
  out.made_from = input.digest;
  for (const VertexName& name : input.names) out.bricks |= name.brick_bit();
  std::vector<std::int32_t> number(input.vertices.size(), -1);
  for (const Vec3i& t : input.triangles)
    if (t.x >= 0) number[t.x] = number[t.y] = number[t.z] = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<std::int32_t>(out.places.size());
    out.places.push_back(static_cast<std::uint32_t>(v)), out.names.push_back(input.names[v]);
  }
  for (std::size_t t = 0; t < input.triangles.size(); ++t) {
    const Vec3i& v = input.triangles[t];
    if (v.x >= 0)
      out.triangles.emplace_back(number[v.x], number[v.y], number[v.z]);
    else if (!compact)
      out.triangles.emplace_back(-1);
  }
  out.triangles.shrink_to_fit(), out.places.shrink_to_fit(), out.names.shrink_to_fit();
  if (compact)
    out.find_rim(input);
  else
    out.begin = input.begin, out.errors.assign(input.errors.begin(), input.errors.end());
  return out;
}

/// Hashes the final triangles and finds their sides without a neighbour.
void GroupResult::find_rim(const GroupInput& input) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3i& v = triangles[t];
    for (int c = 0; c < 3; ++c) {
      const auto [lower, upper] = std::minmax(v[c], v[(c + 1) % 3]);
      rim.push_back({lower, upper, static_cast<std::uint32_t>(t)});
      patch.add(input.vertices[places[v[c]]]);
    }
  }
  patch.finish();
  std::sort(rim.begin(), rim.end());
  const auto in_input = [&](std::uint32_t t) {
    const Vec3i& v = triangles[t];
    return Vec3i(places[v.x], places[v.y], places[v.z]);
  };
  std::size_t kept = 0;
  for (std::size_t n = 0; n < rim.size();) {
    if (n + 1 == rim.size() || rim[n].lower != rim[n + 1].lower || rim[n].upper != rim[n + 1].upper) {
      rim[kept++] = rim[n++];
      continue;
    }
    if (lie_on(input.vertices, in_input(rim[n].triangle), in_input(rim[n + 1].triangle)))
      folded.push_back(rim[n].triangle), folded.push_back(rim[n + 1].triangle);
    n += 2;
  }
  rim.resize(kept);
  rim.shrink_to_fit();
}

GroupResult GroupResult::renamed(const GroupInput& input) const {
  GroupResult out = *this;
  for (std::size_t v = 0; v < places.size(); ++v) out.names[v] = input.names[places[v]];
  out.bricks = 0;
  for (const VertexName& name : input.names) out.bricks |= name.brick_bit();
  return out;
}

bool GroupResult::same_at(int side, const GroupResult& other) const {
  const std::uint32_t from = begin[side], count = begin[side + 1] - from, there = other.begin[side];
  if (other.begin[side + 1] - there != count) return false;
  for (std::uint32_t n = 0; n < count; ++n) {
    const bool removed = triangles[from + n].x < 0;
    if (removed != (other.triangles[there + n].x < 0)) return false;
    if (removed) continue;
    if (errors[from + n] != other.errors[there + n] || corners(from + n) != other.corners(there + n)) return false;
  }
  return true;
}

bool lie_on(const mesh::Vertices& p, const Vec3i& one, const Vec3i& other) {
  constexpr double kLyingOn = -0.9999;
  const auto normal = [&](const Vec3i& v) { return glm::normalize(glm::cross(p[v.y] - p[v.x], p[v.z] - p[v.x])); };
  return glm::dot(normal(one), normal(other)) < kLyingOn;
}

}  // namespace riffler::marching
