// The independent reference for carving with hand tools: whether a point is swept, by poses that lie densely in time.
// It shares nothing with the engine but what it is asked about, the corners of the bodies and the poses: no faces, no
// steps, no intersections with rays, and rotations by quaternions.
#pragma once

#include <span>
#include <vector>

#include "riffler/geom/rolled_pose.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::reference {

class HullPath {
 public:
  /// `hulls`: the corners of each body, which are their convex hulls; `step` (mm): no corner moves farther than this
  /// between two of the poses looked at.
  HullPath(std::span<const std::vector<Vec3>> hulls, std::span<const RolledPose> poses, double step);

  /// Signed distance of p from the bodies at the densest poses, mm: outside at least, within the body's corners; inside
  /// the depth, negative. Right for the motion within half of `step`. Above `enough`, any value above it.
  double operator()(const Vec3& p, double enough) const;

 private:
  struct Facet {
    Vec3 normal;
    double offset;
    std::vector<Vec3> corners;  // in order around it
  };
  struct Body {
    std::vector<Facet> facets;
    Vec3 middle;
    double radius;  // about the middle
  };
  struct Placed {
    Vec3 tip, x, y, z;
  };
  static Body body_of(const std::vector<Vec3>& corners);
  static double distance(const Body& body, const Vec3& p);

  std::vector<Body> bodies_;
  std::vector<Placed> poses_;
};

}  // namespace riffler::reference
