// Collider: the part and its fixtures, with queries for contact, clearance and motions of a tool.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "riffler/collide/assembly.hpp"
#include "riffler/collide/contact.hpp"
#include "riffler/collide/swept.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/nurbs/surface.hpp"

namespace riffler::collide {

/// Part and fixtures, prepared for queries. Immutable after construction; queries may run on several threads. Every
/// query throws std::invalid_argument for a pose whose tip is not finite or whose axis is not of unit length (within
/// 1e-6).
class Collider {
 public:
  /// Direction in which the material of a fixture pushes the tool.
  enum class FixturePush : unsigned char {
    Normal,  ///< against the normal of the tool's surface nearest to it: off the wall that it touches
    Centre,  ///< towards the middle of cutter, shank or holder (4.10), which slides a tool along a wall lengthways
  };
  /// Point spacing and stiffnesses of the force model (4.4).
  struct Settings {
    /// Distance of the sample points on the part, mm; 0: √(area / 100 000), of an exact part √(area / 400 000).
    double spacing = 0;
    double coarse = 4;             ///< factor on `spacing` for points that only shank and holder can touch
    double stiffness = 1;          ///< k of (4.7) for the cutter, N per mm of depth and mm² of surface
    double holder_stiffness = 10;  ///< the same for shank and holder (4.4.3: tracing weak, collision strong)
    /// k_D of (4.9), N per mm³ of fixture inside the tool. Up to 10 a tool held in contact stays quiet (SculptStep); at
    /// 1000 the force may jump by 0.4 N.
    double fixture_stiffness = 10;
    std::vector<double> stiffness_of_each{};  ///< one value per fixture, overriding fixture_stiffness; empty: all
                                              ///< fixtures use fixture_stiffness
    FixturePush fixture_push = FixturePush::Normal;
  };
  /// `part` is treated as a solid: its triangles are oriented by the rules of mesh/orient.hpp, and a cavity in
  /// unbounded material stays a cavity. Fixture volumes share their tiles with the caller. Empty fixtures are ignored.
  /// Throws std::invalid_argument for an empty or invalid mesh, for settings that are negative or not finite, for a
  /// stiffness_of_each whose length is not the number of fixtures, and, with its name, for a fixture that has no mesh
  /// (marching/to_mesh.hpp).
  explicit Collider(const Mesh& part, std::vector<Volume> fixtures, const Settings& settings);
  explicit Collider(const Mesh& part, std::vector<Volume> fixtures = {}) : Collider(part, std::move(fixtures), {}) {}
  /// The same for an exact surface, whose normals point out of the material. Depth and clearance are those of the exact
  /// surface to 1e-6 mm, and the points of the force lie on it. See `sweep` for motions.
  explicit Collider(const nurbs::Surface& part, std::vector<Volume> fixtures, const Settings& settings);
  explicit Collider(const nurbs::Surface& part, std::vector<Volume> fixtures = {})
      : Collider(part, std::move(fixtures), {}) {}
  ~Collider();
  Collider(Collider&&) noexcept;
  Collider& operator=(Collider&&) noexcept;

  /// Force, torque and depth of a tool at a pose, with the contact points: the deepest point first, then the sample
  /// points inside the tool. `budget`: seconds of the monotonic clock; after that the search stops and only bounds what
  /// is left (Contact::missed_depth_bound). Without a budget the result is deterministic.
  Contact query(const Assembly& assembly, const Pose& pose, std::optional<double> budget = {}) const;
  /// As above; adds the operation counts to `counts`.
  Contact query(const Assembly& assembly, const Pose& pose, std::optional<double> budget, Counts& counts) const;
  /// Overwrites `contact` and reuses its memory, so repeated calls from one thread soon allocate nothing. `loose` (mm)
  /// allows the reported depth to fall short by that much, counted in missed_depth_bound; this skips most of the search
  /// where a flank lies flat on a wall. The force does not change.
  void query(const Assembly& assembly, const Pose& pose, std::optional<double> budget, Contact& contact,
             double loose = 0) const;

  /// Smallest signed distance between the part's surface and the outer surface of cutter, shank and holder together,
  /// mm; negative where they overlap. Exact to 1e-9 or rounding, or to 1e-3 in the cases that
  /// Contact::missed_depth_bound describes.
  double clearance(const Assembly& assembly, const Pose& pose) const;
  /// As above; adds the operation counts to `counts`.
  double clearance(const Assembly& assembly, const Pose& pose, Counts& counts) const;
  /// Clearance over part and fixtures, with the closest point. A fixture counts as solid: a tool in its middle is as
  /// deep as the fixture is thick.
  struct Nearest {
    double distance;
    Vec3 point;   ///< on the part or fixture
    Touch touch;  ///< part of the tool that is closest, or Fixture
  };
  /// `loose` (mm): the distance may exceed the smallest by as much, in much less time deep in the material.
  Nearest nearest(const Assembly& assembly, const Pose& pose, double loose = 0) const;
  /// Whether the distance of `nearest` is at least `wanted` (mm). Stops at the first place with less: finding the
  /// minimum takes a hundred times longer where a holder stands inside the part.
  bool keeps(const Assembly& assembly, const Pose& pose, double wanted) const;

  /// Whether the clearance to part and fixtures stays at least `wanted` (mm) along a motion whose two end poses touch
  /// no fixture. Gives up after `most` evaluations and answers Unknown. For an exact surface, the clearances found are
  /// too small by at most 4e-5 of the part's size: Clear is proven, but a motion may be reported as Gouges although its
  /// clearance exceeds `wanted` by up to that much.
  Swept sweep(const Assembly& assembly, const Motion& motion, double wanted, std::size_t most) const;

  /// Whether `p` lies in the part's material, by its winding number (collide/winding.hpp). Needed for a tool entirely
  /// inside the part, which touches none of its surface. For an open surface, material is what the surface mostly
  /// encloses.
  bool inside_part(const Vec3& p) const;

  /// Bounding box of part and fixtures, mm.
  const Box3& bounds() const;

  /// Distance of the sample points on the part, mm.
  double spacing() const;
  /// Number of triangles, sample points and fixtures.
  std::size_t triangles() const;
  std::size_t points() const;
  std::size_t fixtures() const;

 private:
  void query(const Assembly& assembly, const Pose& pose, std::optional<double> budget, Counts& counts, Contact& out,
             double loose) const;

  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace riffler::collide
