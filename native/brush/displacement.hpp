// The displacement field of one dab.
#pragma once

#include "riffler/brush/options.hpp"
#include "riffler/geom/interval.hpp"

namespace riffler::brush {

/// Where a dab acts, mm: a ball about `centre` that moves by `pull`, which is 0 for most brushes.
struct Reach {
  Vec3 centre, pull{0};
  double radius;

  Box3 box() const;
  bool contains(const Vec3& p) const;
  /// The part of the ray through (u, v, ·) along `axis`, in its cyclic frame.
  Interval along(Axis axis, double u, double v) const;
};

class Displacement {
 public:
  /// `axis`: unit vector. Length of `pull`: 0 except for Grab and SnakeHook.
  Displacement(const BrushOptions& options, const Reach& reach, const Vec3& axis);

  const Reach& reach() const { return reach_; }
  /// Sets the plane of Flatten, Scrape and Fill: a point of it and its unit normal.
  void set_plane(const Vec3& point, const Vec3& normal) { point_ = point, axis_ = normal; }
  const Vec3& axis() const { return axis_; }
  bool needs_plane() const;
  /// The falloff at p, times the strength.
  double weight(const Vec3& p) const;
  /// 1 where a surface with the normal n faces the axis, 0 where it looks sideways or away.
  double facing(const Vec3& n) const;
  /// The displacement of a surface point p with the unit normal n. It never takes p out of the reach.
  Vec3 operator()(const Vec3& p, const Vec3& n) const;

 private:
  Vec3 free(const Vec3& p, const Vec3& n) const;

  Kind kind_;
  Falloff falloff_;
  double strength_, amount_;
  Reach reach_;
  Vec3 axis_, point_;
};

}  // namespace riffler::brush
