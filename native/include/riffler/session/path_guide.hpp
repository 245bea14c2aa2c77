// A path as the guide of a tool: its cutter stays on the path, its axis is free.
#pragma once

#include "riffler/haptics/guide.hpp"
#include "riffler/plan/contact_location.hpp"
#include "riffler/plan/path.hpp"

namespace riffler::session {

/// The cutter stands as plan::location_on_path places it; between two points of the path its tip moves on a straight
/// line. A sliding guide lets it move along the path, a resting one does not.
class PathGuide final : public haptics::Guide {
 public:
  /// Throws std::invalid_argument for a path without points, for a point outside it, and for an axis with which the
  /// cutter cannot touch there.
  PathGuide(const plan::PencilPath& path, const Tool& tool, std::size_t point, const Vec3& axis, bool slides);

  Pose settled(const Pose& wanted) noexcept override;
  Freedoms freedoms() const noexcept override;

  /// Moves the tool to a point of the path, with the axis that it has. Throws std::invalid_argument as the constructor,
  /// and then changes nothing.
  void go_to(std::size_t point);
  void set_slides(bool slides) { slides_ = slides; }

  /// Place on the path as a point index with a fraction: 2.25 lies a quarter of the edge after point 2. On a closed
  /// path it is less than the number of points.
  double station() const { return station_; }
  /// The nearest point of the path.
  std::size_t point() const;
  const Pose& pose() const { return pose_; }

 private:
  bool tip_at(double station, const Vec3& axis, Vec3& tip) const noexcept;
  bool nearest(const Pose& wanted, double& station) const noexcept;
  double to_end(int step) const noexcept;
  double last() const;
  double wrapped(double station) const;

  plan::PencilPath path_;
  plan::CutterSupport cutter_;
  bool slides_;
  double station_ = 0;
  Pose pose_;
};

}  // namespace riffler::session
