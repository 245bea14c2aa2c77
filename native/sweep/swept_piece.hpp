// One convex piece of a tool, translated along a straight step, against rays along +w: always one interval.
#pragma once

#include "geom/interval.hpp"
#include "geom/vec.hpp"
#include "tool/piece.hpp"

namespace riffler {

/// What surface of the swept body a hit lies on; decides its normal.
enum class Surface : unsigned char {
  Lateral,  ///< the piece's own side, at one end of the step or on its silhouette
  Bottom,   ///< the flat face at z0
  Top,      ///< the flat face at z1
  Rim0,     ///< swept by the edge of the face at z0
  Rim1      ///< swept by the edge of the face at z1
};

/// One end of the interval in which a ray meets the swept body.
struct SweptHit {
  double s = 0;    ///< coordinate along the ray
  double way = 0;  ///< how far the tool has moved along the straight way there, mm
  Surface surface = Surface::Lateral;
};

/// The numbers of a SweptPiece, for kernels. Frame: three vectors e1, e2, axis with e1 × e2 = axis, the rays in the
/// plane of axis and e1: their direction is tilt e1 + oz axis.
struct SweptShape {
  /// A ray through the line that a cone's apex sweeps touches its side in a double root (at_most_zero).
  static constexpr double kTangent = 1e-13;
  enum class Kind : unsigned char { Frustum, Ball, Torus } kind;
  bool cut_bottom, cut_top;  ///< a Round that ends in a flat face there
  double tip[3], axis[3], e1[3], e2[3];
  double tilt, oz;
  double way, m1, m2, mo;        ///< length of the motion and its unit vector in the frame
  double z0, z1, r0, r1, slope;  ///< ends and dr/dz
  double e, zc, r;               ///< Round
  double low, high;              ///< heights between which its side is
};

/// The body that a convex piece sweeps on a straight way at fixed orientation. It is convex, so a ray meets it in one
/// interval; in the plane spanned by ray and motion, with coordinates (s along the ray, τ along the way), its section
/// is { piece at τ contains the point } ∩ { 0 ≤ τ ≤ way }, a convex set of which [near, far] are the extreme s. The
/// extremes are taken over *all* hits that lie in the body (the piece at both ends of the way, its two faces swept, the
/// silhouette n · V = 0): every candidate belongs to the body and every part of its boundary has one, so no case
/// analysis can open or invert an interval (methods: "Tool motion and its swept volume").
/// Frame: the cyclic frame of a grid, rays along its third axis. Exact to rounding for Frustum and ball; the torus and
/// the barrel are solved by Newton's method on a convex function to rounding.
class SweptPiece {
 public:
  /// The piece stands with the tool's tip at `tip`, axis `axis` (unit), and moves by `motion` (may be zero).
  SweptPiece(const Piece& piece, const Vec3& tip, const Vec3& axis, const Vec3& motion);

  /// Interval of the ray through (u, v); false where it misses the body.
  bool hit(double u, double v, SweptHit& near, SweptHit& far) const;
  /// Unit normal, out of the body, at a hit of the ray through (u, v).
  Vec3 normal(double u, double v, const SweptHit& hit) const;
  SweptShape shape() const;

 private:
  /// A ray in the coordinates of the section: its point (s, τ) is tip + (x + s tilt − τ m1) e1 + (y − τ m2) e2 +
  /// (z + s oz − τ mo) axis. s counts from the height of the tip, so that coordinates far from the origin lose nothing.
  struct Ray {
    double x, y, z, oz;
  };
  /// The lowest and the highest of the hits found so far.
  struct Extremes {
    SweptHit near{std::numeric_limits<double>::infinity(), 0, Surface::Lateral};
    SweptHit far{-std::numeric_limits<double>::infinity(), 0, Surface::Lateral};
    void add(double s, double way, Surface surface) {
      if (s < near.s) near = {s, way, surface};
      if (s > far.s) far = {s, way, surface};
    }
  };
  Ray ray(double u, double v) const;
  void frustum(const Ray& ray, Extremes& out) const;
  void ball(const Ray& ray, Extremes& out) const;
  void torus(const Ray& ray, Extremes& out) const;
  Interval frustum_at(const Ray& ray, double way) const;
  Interval slab_at(const Ray& ray, double way) const;
  void face(const Ray& ray, double z, double radius, Surface flat, Surface rim, Extremes& out) const;
  void clip_faces(const Ray& ray, Extremes& out) const;
  /// swept_round.cpp
  struct Gap;
  Gap gap(const Ray& ray, double s, double way) const;
  double nearest_way(const Ray& ray, double s, const Interval& ways, double guess) const;
  bool extreme(const Ray& ray, double sign, const Interval& ways, SweptHit& out) const;
  bool between(const Ray& ray, double outside, double beyond, const Interval& ways, SweptHit& out) const;

  using Kind = SweptShape::Kind;
  Kind kind_;
  bool cut_bottom_ = false, cut_top_ = false;  // a Round that ends in a flat face there
  Vec3 tip_, axis_, e1_, e2_;                  // e1 × e2 = axis; the ray lies in the plane of axis and e1
  double tilt_;                                // sine between axis and ray: the ray's component along e1
  double way_;                                 // length of the motion, mm
  Vec3 direction_;                             // its unit vector, or zero
  double m1_, m2_, mo_;                        // its components along e1, e2 and the axis
  double z0_, z1_, r0_, r1_, slope_;           // ends and dr/dz (Frustum)
  double e_ = 0, zc_ = 0, r_ = 0;              // torus (Round)
  double low_, high_;                          // heights between which its side is, up to rounding
};

}  // namespace riffler
