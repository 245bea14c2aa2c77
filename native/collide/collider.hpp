// The part and its fixtures, against which tools are held.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "collide/contact.hpp"
#include "dexel/volume.hpp"
#include "geom/pose.hpp"
#include "mesh/mesh.hpp"
#include "tool/outline.hpp"

namespace riffler {

/// A tool made ready for contact: prepare it once, use it for many poses, from any number of threads.
class Assembly {
 public:
  explicit Assembly(const Tool& tool);

  const Tool& tool() const { return tool_; }
  const Outline& outline() const { return outline_; }
  /// Largest distance of any of its points from the tip, mm.
  double reach() const { return reach_; }

 private:
  Tool tool_;
  Outline outline_;
  double reach_;
};

/// Immutable after construction; queries may run on several threads.
class Collider {
 public:
  struct Settings {
    double spacing = 0;    ///< of the points on the part against the cutter, mm; 0: chosen from the part
    double stiffness = 1;  ///< k of (4.7), N per mm of depth and mm² of surface
  };
  /// Copies nothing of the volumes but pointers to their tiles. std::invalid_argument for an empty or invalid mesh.
  explicit Collider(const Mesh& part, std::vector<Volume> fixtures, const Settings& settings);
  explicit Collider(const Mesh& part, std::vector<Volume> fixtures = {}) : Collider(part, std::move(fixtures), {}) {}
  ~Collider();
  Collider(Collider&&) noexcept;
  Collider& operator=(Collider&&) noexcept;

  /// `budget`: seconds, after which what is left is only bounded.
  Contact query(const Assembly& assembly, const Pose& pose, std::optional<double> budget = {}) const;

  /// Least signed distance between the part's surface and the union of cutter, shank and holder; negative where they
  /// overlap, to the union's outer surface. mm, exact to rounding.
  double clearance(const Assembly& assembly, const Pose& pose) const;
  /// As clearance, over the part and the fixtures, and where it is.
  struct Nearest {
    double distance;
    Vec3 point;   ///< of part or fixture
    Touch touch;  ///< what of the tool it is next to, or Fixture
  };
  Nearest nearest(const Assembly& assembly, const Pose& pose) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace riffler
