// Local linear regression (Cleveland 1979) of heights over the plane perpendicular to the mean normal. Unlike averaging
// the neighbours' positions, it keeps planes unchanged at their borders too, where all neighbours are on one side.
#include "dexel/smooth/relax.hpp"

#include "dexel/joiner.hpp"
#include "geom/hypot.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::dexel {

double Brush::share(const Vec3& p) const {
  const Vec3 r = p - centre;
  const double t2 = glm::dot(r, r) / (radius * radius);
  return t2 < 1 ? strength * (1 - t2 * t2) * (1 - t2 * t2) : 0;
}

namespace {

/// Weighted sums over a point's neighbours, lengths in units of the reach.
struct Moments {
  double weight = 0;
  Vec3 normal{0}, place{0};
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(double w, const Vec3& r, const Vec3& n) {
    weight += w, normal += w * n;
    const Vec3 wr = w * r;
    place += wr;
    xx += wr.x * r.x, xy += wr.x * r.y, xz += wr.x * r.z;
    yy += wr.y * r.y, yz += wr.y * r.z, zz += wr.z * r.z;
  }
  Mat3 covariance() const {
    const Vec3 c = place / weight;
    const Mat3 second(Vec3(xx, xy, xz), Vec3(xy, yy, yz), Vec3(xz, yz, zz));
    return second / weight - glm::outerProduct(c, c);
  }
};

/// A plane near the origin.
struct Plane {
  Vec3 normal;
  double height;  // along the normal
};

/// Fits height = a + b · place, with heights along the mean normal n and places perpendicular to it.
Plane fit(const Moments& m, const Vec3& own_normal) {
  const double length = glm::length(m.normal);
  const Vec3 n = length > 1e-6 * m.weight ? m.normal / length : own_normal;
  const Mat3 covariance = m.covariance(), across = Mat3(1) - glm::outerProduct(n, n);
  // The ridge term keeps slopes finite if the neighbours lie in a row. Packed normals have errors up to 5e-5, which the
  // slope corrects except for 1e-6 of the error, due to the ridge.
  constexpr double ridge = 1e-7;
  const Mat3 spread = across * covariance * across + ridge * Mat3(1) + glm::outerProduct(n, n);
  const Vec3 slope = across * (glm::inverse(spread) * (across * (covariance * n)));
  const Vec3 mean = m.place / m.weight;
  const double steepness = std::sqrt(1 + glm::dot(slope, slope));
  return {(n - slope) / steepness, (glm::dot(n, mean) - glm::dot(slope, mean)) / steepness};
}

/// Sorts points by columns along z, so that runs of neighbours are contiguous in memory.
std::vector<EndPoint> sorted(const std::vector<EndPoint>& points, const Columns& columns) {
  std::vector<EndPoint> out;
  out.reserve(points.size());
  for (const std::uint32_t k : columns.order()) out.push_back(points[k]);
  return out;
}

std::vector<Vec3> places(const std::vector<EndPoint>& points) {
  std::vector<Vec3> out;
  out.reserve(points.size());
  for (const EndPoint& p : points) out.push_back(p.place);
  return out;
}

/// The plane through the neighbours of `p`, relative to p; heights in mm.
Plane plane_around(const EndPoint& p, const std::vector<EndPoint>& points, const Columns& columns, double reach) {
  Moments moments;
  const double inverse = 1 / reach;
  columns.for_each_run({p.place - Vec3(reach), p.place + Vec3(reach)}, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const EndPoint& q = points[k];
      const Vec3 r = (q.place - p.place) * inverse;
      const double rest = 1 - glm::dot(r, r);
      if (rest <= 0) continue;
      const double weight = rest * rest * rest * q.area * same_sheet(glm::dot(p.normal, q.normal));
      if (weight > 0) moments.add(weight, r, q.normal);
    }
  });
  Plane plane = fit(moments, p.normal);
  plane.height *= reach;
  return plane;
}

}  // namespace

std::vector<MovedPoint> relax(const std::vector<EndPoint>& unsorted, double pitch, const Brush& brush,
                              const Progress& progress) {
  const double reach = kRelaxReach * pitch, farthest = kFarthestMove * pitch;
  const Columns columns(Axis::Z, places(unsorted), 0.5 * reach);
  const std::vector<EndPoint> points = sorted(unsorted, columns);
  std::vector<MovedPoint> out(points.size());
  constexpr std::size_t grain = 64;
  base::parallel_for(
      points.size(), grain,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const EndPoint& p = points[k];
          MovedPoint& m = out[k];
          m = {p.place, p.place, p.normal, p.normal};
          const double share = p.held ? 0 : brush.share(p.place);
          if (share == 0) continue;
          const Plane plane = plane_around(p, points, columns, reach);
          const double height = plane.height, way = share * height / geom::hypot(1, height / farthest);
          if (std::abs(way) < kSliver * pitch) continue;
          const Vec3 normal = p.normal + share * (plane.normal - p.normal);
          const double length = glm::length(normal);
          m.after += way * plane.normal, m.way = std::abs(way);
          if (length > 1e-3) m.normal_after = normal / length;
        }
      },
      progress);
  return out;
}

}  // namespace riffler::dexel
