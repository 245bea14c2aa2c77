// Planning by feel: a device turns the tool on a path, its buttons set and delete key orientations.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "riffler/pen/device.hpp"
#include "riffler/plan/orientation.hpp"
#include "riffler/session/orient_loop.hpp"

namespace riffler::session {

/// Settings of a session.
struct OrientSessionSettings {
  OrientSettings loop{};
  std::size_t point = 0;     ///< point of the path at which the tool starts
  std::optional<Vec3> axis;  ///< of the tool at the start; default: the path's axis there, or halfway between its walls
  plan::Interpolation interpolation = plan::Interpolation::Smooth;  ///< between keys
  std::optional<plan::AxisLimit> limit;                             ///< what the machine allows a key
  double reach = 2;  ///< mm along the path within which the delete button finds a key

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// What a press of a button did.
struct KeyChange {
  double time = 0;        ///< s since the start
  std::size_t point = 0;  ///< of the path
  Vec3 axis{0, 0, 1};     ///< of the key set or deleted
  bool deleted = false;
  std::string refused;  ///< why nothing was changed; empty if it was
};

/// What happened between two frames.
struct OrientFrame {
  std::vector<OrientTick> ticks;
  std::vector<KeyChange> changes;
  std::uint64_t dropped_ticks = 0;    ///< ticks lost since the start, because frames were too rare
  std::uint64_t dropped_presses = 0;  ///< presses lost likewise
};

/// Functions are for one thread.
class OrientSession {
 public:
  /// Validates settings, path and point; begins with the keys of `path`. The device's thread queries `obstacles`: part
  /// and fixtures. A device without force skips the checks of its motion. Throws std::invalid_argument.
  OrientSession(const plan::PencilPath& path, const Tool& tool, std::shared_ptr<pen::Pen> pen,
                std::shared_ptr<const collide::Collider> obstacles, const OrientSessionSettings& settings);
  OrientSession(const OrientSession&) = delete;
  OrientSession& operator=(const OrientSession&) = delete;
  ~OrientSession();

  /// Starts, in the device's own thread, or in one that polls it a thousand times a second. Call it once.
  void start();
  bool running() const noexcept;
  /// How the system runs the thread of the steps.
  base::ThreadPriority priority() const;
  /// Ends the force and returns what no frame has returned. Throws std::runtime_error in a process forked while the
  /// session ran, as frame() does.
  OrientFrame stop();
  /// Applies the presses since the last call to the keys, and returns what happened.
  OrientFrame frame();

  /// The keys; they may be replaced while the session runs. Throws std::invalid_argument as plan::oriented, and then
  /// changes nothing.
  const plan::OrientationKeys& keys() const noexcept;
  void set_keys(const plan::OrientationKeys& keys);
  /// The path with the axes between the keys; without keys, as given.
  const plan::PencilPath& path() const noexcept;

  OrientLoop& loop() noexcept;
  pen::Pen& pen() noexcept;

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace riffler::session
