// COL: how long it takes to hold a tool against a part, what was missed, and how a force changes over an edge.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/contact_scene.hpp"

namespace riffler::bench {

/// One question that is asked at every pose, of ours or of another library.
struct Ask {
  std::string engine, what;
  std::function<double(const Pose&)> call;  ///< depth, distance or number of contacts
  double build_s = 0;                       ///< processor time of what was prepared for it
  int most = 1 << 30;                       ///< poses, where it is slow
};

/// What others are given: the part, the tool as a mesh, and its solids.
struct ContactCase {
  const Mesh& part;
  const Tool& tool;
  const Mesh& tool_mesh;
};
/// The questions of one other library.
using Rival = std::function<std::vector<Ask>(const ContactCase&)>;

struct ContactOptions {
  std::string part{};  ///< as for contact_part; empty: a sheet of valleys
  int squares = 316;   ///< of that sheet: 199 712 triangles; 100: 20 000
  std::string tool = "long";
  int poses = 2000;
  std::uint64_t seed = 1;
  int repeats = 3;  ///< of each question at each pose; the median counts
};

/// All questions in turn, by blocks of poses, one thread: JSON with processor times of every pose (µs) and answers, and
/// the share of the poses that collide, of those whose holder is deepest, and of those whose depth is in doubt by more
/// than 0.05 mm after 200 µs.
std::string contact_times(const ContactOptions& options, const std::vector<Rival>& rivals = {});

/// Queries with budgets (s), compared with those without: JSON with time, missed depth and its bound for every pose.
std::string contact_budgets(const ContactOptions& options, const std::vector<double>& budgets);

/// Depths against the independent reference: JSON with differences from the least over `points` points spread over the
/// part at `options.poses` poses, and from the bracket over all triangles, to `gap`, at `brackets` of them.
std::string contact_errors(const ContactOptions& options, std::size_t points, int brackets, double gap);

/// A ball R3 slides off a plane over its edge, 0.2 mm deep: JSON with positions, forces and the integral of stiffness ×
/// depth over the plane by the reference's distance.
std::string contact_slide(int steps);

/// How deep the mesh's surface enters the tool at each pose by the independent reference (reference/surface_entry.hpp):
/// as attained and as proven, mm.
std::vector<std::array<double, 2>> contact_entries(const Mesh& mesh, const Tool& tool, std::span<const Pose> poses,
                                                   double gap);

}  // namespace riffler::bench
