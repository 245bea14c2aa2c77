// Model of a family of HID devices. A new family is one file with a model, and one line in registry.cpp.
#pragma once

#include "pen/hid/hid_transport.hpp"
#include "pen/pen_model.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {

class HidModel : public PenModel {
 public:
  /// Checks that a newly opened device is this device, in the expected state. Throws OpenError. Not in the driver's
  /// thread, and never while that thread uses the model.
  virtual void check(HidTransport& transport) = 0;
};

}  // namespace riffler::pen
