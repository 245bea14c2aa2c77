// COL: measures the time of contact queries, the depth that they miss, and the change of a force over an edge.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/contact_scene.hpp"

namespace riffler::bench {

/// One query of Riffler or of another library, to be timed at every pose.
struct Ask {
  std::string engine, what;
  std::function<double(const Pose&)> call;  ///< depth, distance or number of contacts
  double build_s = 0;                       ///< processor time of its preparation
  int most = 1 << 30;                       ///< largest number of poses; set for slow queries
};

/// Input of other libraries: the part, and the tool as a mesh and as solids.
struct ContactCase {
  const Mesh& part;
  const Tool& tool;
  const Mesh& tool_mesh;
};
/// Returns the queries of one other library.
using Rival = std::function<std::vector<Ask>(const ContactCase&)>;

struct ContactOptions {
  std::string part{};  ///< as for contact_part; empty: a sheet of valleys
  int squares = 316;   ///< of that sheet: 199 712 triangles; 100: 20 000
  std::string tool = "long";
  int poses = 2000;
  std::uint64_t seed = 1;
  int repeats = 3;  ///< of each query at each pose; the median counts
};

/// Times all queries in turn, by blocks of poses, on one thread. Returns JSON with the processor time (µs) and result
/// of every pose, and the shares of poses that collide, whose holder is deepest, and whose depth is uncertain by more
/// than 0.05 mm after 200 µs, and the mean time of a query far above the part.
std::string contact_times(const ContactOptions& options, const std::vector<Rival>& rivals = {});

/// Compares queries with budgets (s) with those without. Returns JSON with time, missed depth and its bound for every
/// pose.
std::string contact_budgets(const ContactOptions& options, const std::vector<double>& budgets);

/// Compares depths with the independent reference. Returns JSON with differences from the smallest distance of `points`
/// points spread over the part at `options.poses` poses, and from the bracket over all triangles, to `gap`, at
/// `brackets` of them.
std::string contact_errors(const ContactOptions& options, std::size_t points, int brackets, double gap);

/// Slides a ball R3, 0.2 mm deep, off a plane over its edge. Returns JSON with positions, forces and the integral of
/// stiffness × depth over the plane by the reference's distance.
std::string contact_slide(int steps);

/// Depth (mm) to which the mesh's surface enters the tool at each pose, by the independent reference
/// (reference/surface_entry.hpp): the attained and the proven one.
std::vector<std::array<double, 2>> contact_entries(const Mesh& mesh, const Tool& tool, std::span<const Pose> poses,
                                                   double gap);

}  // namespace riffler::bench
