#include "pen/library/hd_devices.hpp"

#include <string>
#include <utility>

#include "pen/driven_pen.hpp"
#include "pen/library/arm_model.hpp"
#include "pen/library/arm_process.hpp"
#include "pen/library/library_place.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {
namespace {

constexpr const char* kHdVariable = "RIFFLER_LIBHD";
constexpr const char* kInstallHd =
    "install 3D Systems' OpenHaptics and Touch driver (https://support.3dsystems.com) and set RIFFLER_LIBHD to the "
    "whole path of its libHD.so";

LibraryPlace hd_place() {
  return find_library(kHdVariable, {"libHD.so"});
}

ArmLibrary hd_library() {
  const LibraryPlace place = hd_place();
  if (place.path.empty()) throw OpenError(OpenProblem::NotInstalled, std::string("there is no libHD; ") + kInstallHd);
  return {"hd", place.path, kInstallHd};
}

FoundDevice touch_entry() {
  FoundDevice out;
  out.path = kTouchKind;
  out.name = "3D Systems Touch";
  out.maker = "3D Systems";
  return out;
}

}  // namespace

std::vector<FoundDevice> find_touch() {
  FoundDevice out = touch_entry();
  const LibraryPlace place = hd_place();
  try {
    if (!place.path.empty() && !place.chosen)
      throw OpenError(OpenProblem::NotChosen, place.path + " is there; open the arm as \"touch\", or set " +
                                                  kHdVariable + " to that path to have it listed");
    const std::vector<FoundArm> found = list_arms(hd_library());
    out.was_opened = true;
    if (found.empty()) throw OpenError(OpenProblem::NoFile, "the library finds no arm");
    const FoundArm& arm = found.front();
    if (arm.problem != OpenProblem::None) throw OpenError(arm.problem, arm.text);
    const ArmModel model(arm.traits);
    out.name = arm.traits.name;
    out.serial = arm.traits.serial;
    out.capability = capability_text(model.capability());
    out.about = model.about();
  } catch (const OpenError& error) {
    out.problem = error.problem();
    out.text = error.what();
    // With the library at hand, an arm that does not open is a device that does not open.
    out.is_there = out.was_opened;
  }
  return {out};
}

std::unique_ptr<Pen> open_touch(std::string_view name, const PenOptions& options) {
  const ArmLibrary library = hd_library();
  auto arm = std::make_unique<ArmProcess>(library, std::string(name));
  auto model = std::make_shared<ArmModel>(arm->traits());
  auto again = [library, name = std::string(name)]() -> std::unique_ptr<Transport> {
    return std::make_unique<ArmProcess>(library, name);
  };
  return std::make_unique<DrivenPen>(kTouchKind, std::move(model), std::move(arm), std::move(again), options.driver);
}

}  // namespace riffler::pen
