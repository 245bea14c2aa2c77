// Tablet and mouse: the host application (Blender) passes their events here, and they become poses.
#pragma once

#include "riffler/pen/device.hpp"
#include "riffler/pen/published.hpp"

namespace riffler::pen {

/// The pointer's plane in the pose frame and its units. For a mouse in a view: the view plane through the point being
/// worked on.
struct PointerFrame {
  Vec3 origin{0};                    ///< position of pointer (0, 0), mm
  Vec3 right{1, 0, 0}, up{0, 1, 0};  ///< orthogonal unit vectors
  double scale = 1;                  ///< mm per pointer unit
  double depth = 2;                  ///< mm into the plane (against right × up) at full pressure
  double max_tilt = 1.0;  ///< rad: near the horizon tablets report invalid values, and beyond it the axis flips

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// One event of a tablet or mouse.
struct PointerEvent {
  double x = 0, y = 0;            ///< right and up, in pointer units
  double pressure = 0;            ///< 0 … 1; a mouse's button is 1
  double tilt_x = 0, tilt_y = 0;  ///< rad from upright, of the pen's end to the right and up; 0 for mice
  std::uint32_t buttons = 0;
  double time = 0;  ///< s on the caller's clock
};

/// Direction of the pen from its tip to its end: right × up, tilted. Tilts of ±90° or NaN are limited to `max_tilt`
/// from upright.
Vec3 tilted_axis(const PointerFrame& frame, double tilt_x, double tilt_y) noexcept;

/// A tablet or mouse as a device without force.
class PointerPen final : public Pen {
 public:
  enum class Kind : unsigned char { Tablet, Mouse };
  /// Throws std::invalid_argument for an invalid frame.
  explicit PointerPen(Kind kind, const PointerFrame& frame = {});

  /// Sets a new frame, for example when the view turns. Call it from the thread that calls give(). Throws
  /// std::invalid_argument for an invalid frame.
  void set_frame(const PointerFrame& frame);
  /// Passes an event. One thread only. Returns false for an event that is not finite or is older than the last; it is
  /// ignored.
  bool give(const PointerEvent& event) noexcept;

  std::string kind() const override { return kind_ == Kind::Tablet ? "tablet" : "mouse"; }
  bool in_part_frame() const noexcept override { return true; }
  const DeviceCapability& capability() const noexcept override { return capability_; }
  PenSample newest() const noexcept override { return newest_.get(); }
  /// Time of the last event: between events a pointer stands still.
  double now() const noexcept override { return newest_.get().time; }

 private:
  Kind kind_;
  PointerFrame frame_;
  DeviceCapability capability_;
  PenSample last_{};
  Published<PenSample> newest_;
};

}  // namespace riffler::pen
