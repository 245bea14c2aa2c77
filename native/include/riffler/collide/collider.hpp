// The part and its fixtures, against which tools are held.
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

namespace riffler::collide {

/// Immutable after construction; queries may run on several threads. Poses whose tip is not finite or whose axis is
/// not of unit length (to 1e-6) are a std::invalid_argument.
class Collider {
 public:
  struct Settings {
    double spacing = 0;            ///< of the points on the part, mm; 0: √(its area / 100 000)
    double coarse = 4;             ///< away from the cutter, points are this many times as far apart
    double stiffness = 1;          ///< k of (4.7) against the cutter, N per mm of depth and mm² of surface
    double holder_stiffness = 10;  ///< the same against shank and holder (4.4.3: tracing weak, collision strong)
    /// k_D of (4.9), N per mm³ of a fixture in the tool. Up to 10 a held tool is quiet (SculptStep); at 1000 some 0.4 N
    /// may come at once.
    double fixture_stiffness = 10;
    std::vector<double> stiffness_of_each{};  ///< fixture, in the place of that; or empty: all are alike
  };
  /// The part is a solid: its triangles are turned as mesh/orient.hpp says, room in endless material kept. Copies
  /// nothing of the volumes but pointers to their tiles. std::invalid_argument for an empty or invalid mesh, for
  /// settings that are negative or not finite or as many as no fixtures are, and where a fixture has no mesh
  /// (marching/to_mesh.hpp), naming it. An empty fixture is nothing, and ignored.
  explicit Collider(const Mesh& part, std::vector<Volume> fixtures, const Settings& settings);
  explicit Collider(const Mesh& part, std::vector<Volume> fixtures = {}) : Collider(part, std::move(fixtures), {}) {}
  ~Collider();
  Collider(Collider&&) noexcept;
  Collider& operator=(Collider&&) noexcept;

  /// Force, torque, depth and where: the deepest point first, then the sample points that are in the tool. `budget`:
  /// seconds by the monotonic clock, after which what is left is only bounded; without it the result is always the
  /// same.
  Contact query(const Assembly& assembly, const Pose& pose, std::optional<double> budget = {}) const;
  Contact query(const Assembly& assembly, const Pose& pose, std::optional<double> budget, Counts& counts) const;
  /// Writes over `contact`: asked again and again by one thread, it soon asks the system for no memory. The depth may
  /// be less than the true one by `loose` mm, which is part of what may have been missed: where a side lies flat on a
  /// wall, that spares most of the search. The force is the same.
  void query(const Assembly& assembly, const Pose& pose, std::optional<double> budget, Contact& contact,
             double loose = 0) const;

  /// Least signed distance between the part's surface and the union of cutter, shank and holder; negative where they
  /// overlap, to the union's outer surface. mm, exact to 1e-9 or rounding; to 1e-3 where
  /// `missed_depth_bound` says so.
  double clearance(const Assembly& assembly, const Pose& pose) const;
  double clearance(const Assembly& assembly, const Pose& pose, Counts& counts) const;
  /// As clearance, over the part and the fixtures, and where it is. A fixture is solid: in the middle of one a tool is
  /// as deep as it is thick.
  struct Nearest {
    double distance;
    Vec3 point;   ///< of part or fixture
    Touch touch;  ///< what of the tool it is next to, or Fixture
  };
  Nearest nearest(const Assembly& assembly, const Pose& pose) const;
  /// Whether that distance is at least `wanted`. The first place with less will do: how deep the least one is takes
  /// a hundred times longer to prove where a holder stands in the part.
  bool keeps(const Assembly& assembly, const Pose& pose, double wanted) const;

  /// Whether the clearance from part and fixtures is at least `wanted` all along a motion, from and to poses that are
  /// in no fixture; gives up after `most` evaluations.
  Swept sweep(const Assembly& assembly, const Motion& motion, double wanted, std::size_t most) const;

  /// Whether a point is in the part's material, behind its normals, by its winding number (collide/winding.hpp): a tool
  /// that the part has swallowed whole touches none of its surface. Of an open surface only what it mostly surrounds is
  /// its material.
  bool inside_part(const Vec3& p) const;

  /// Box around part and fixtures, mm.
  const Box3& bounds() const;

  double spacing() const;
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
