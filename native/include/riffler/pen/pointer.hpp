// Tablet and mouse: whoever gets their events (Blender) gives them here, and they become poses.
#pragma once

#include "riffler/pen/device.hpp"
#include "riffler/pen/published.hpp"

namespace riffler::pen {

/// Where the pointer's plane lies in the frame of poses, and what its numbers mean there. For a mouse in a view: the
/// plane of the view through the point that is being worked on.
struct PointerFrame {
  Vec3 origin{0};                    ///< of pointer (0, 0), mm
  Vec3 right{1, 0, 0}, up{0, 1, 0};  ///< unit vectors, square to each other
  double scale = 1;                  ///< mm for a unit of the pointer
  double depth = 2;                  ///< mm into the plane (against right × up) at full pressure
  double most_tilt = 1.0;            ///< rad: tablets tell nonsense near the horizon, and beyond it the axis turns over

  /// std::invalid_argument naming the field.
  void validate() const;
};

struct PointerEvent {
  double x = 0, y = 0;            ///< right and up, in units of the frame
  double pressure = 0;            ///< 0 … 1; a mouse's button is 1
  double tilt_x = 0, tilt_y = 0;  ///< rad by which the pen's end leans to the right and up from upright; mice have 0
  std::uint32_t buttons = 0;
  double time = 0;  ///< s of the giver's clock
};

/// right × up leaning by the tilts: direction of the pen from its tip to its end. With tilts of ±90° or NaN it is held
/// to `most_tilt` from upright.
Vec3 tilted_axis(const PointerFrame& frame, double tilt_x, double tilt_y) noexcept;

class PointerPen final : public Pen {
 public:
  enum class Kind : unsigned char { Tablet, Mouse };
  /// Validates.
  explicit PointerPen(Kind kind, const PointerFrame& frame = {});

  /// The view has turned, or another point is worked on. By the giver's thread. Validates.
  void set_frame(const PointerFrame& frame);
  /// By one thread. An event that is not finite, or older than the last, is left out: false.
  bool give(const PointerEvent& event) noexcept;

  std::string kind() const override { return kind_ == Kind::Tablet ? "tablet" : "mouse"; }
  bool in_part_frame() const noexcept override { return true; }
  const DeviceCapability& capability() const noexcept override { return capability_; }
  PenSample newest() const noexcept override { return newest_.get(); }
  /// The time of the last event: between events a pointer stands still.
  double now() const noexcept override { return newest_.get().time; }

 private:
  Kind kind_;
  PointerFrame frame_;
  DeviceCapability capability_;
  PenSample last_{};
  Published<PenSample> newest_;
};

}  // namespace riffler::pen
