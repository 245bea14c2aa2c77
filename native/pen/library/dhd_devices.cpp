#include "pen/library/dhd_devices.hpp"

#include <string>
#include <utility>

#include "pen/driven_pen.hpp"
#include "pen/library/arm_model.hpp"
#include "pen/library/arm_process.hpp"
#include "pen/library/library_place.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {
namespace {

constexpr const char* kDhdVariable = "RIFFLER_LIBDHD";
constexpr const char* kInstallDhd =
    "install Force Dimension's SDK (https://www.forcedimension.com/software/sdk) and set RIFFLER_LIBDHD to the whole "
    "path of its libdhd.so";

LibraryPlace dhd_place() {
  return find_library(kDhdVariable, {"libdhd.so.3", "libdhd.so"});
}

ArmLibrary dhd_library() {
  const LibraryPlace place = dhd_place();
  if (place.path.empty()) throw OpenError(OpenProblem::NotInstalled, std::string("there is no libdhd; ") + kInstallDhd);
  return {"dhd", place.path, kInstallDhd};
}

FoundDevice describe_dhd(const FoundArm& arm) {
  FoundDevice out;
  out.path = kForceDimensionKind;
  out.name = "Force Dimension arm";
  out.maker = "Force Dimension";
  out.was_opened = true;
  if (arm.problem != OpenProblem::None) {
    out.problem = arm.problem;
    out.text = "arm " + arm.key + ": " + arm.text;
    return out;
  }
  const ArmModel model(arm.traits);
  out.path += ":" + arm.traits.serial;
  out.name = arm.traits.name;
  out.serial = arm.traits.serial;
  out.capability = capability_text(model.capability());
  out.about = model.about();
  return out;
}

FoundDevice dhd_not_there(OpenProblem problem, const std::string& text) {
  FoundDevice out;
  out.path = kForceDimensionKind;
  out.name = "Force Dimension arm";
  out.maker = "Force Dimension";
  out.is_there = false;
  out.problem = problem;
  out.text = text;
  return out;
}

}  // namespace

std::vector<FoundDevice> find_force_dimension() {
  const LibraryPlace place = dhd_place();
  if (!place.path.empty() && !place.chosen)
    return {dhd_not_there(OpenProblem::NotChosen, place.path +
                                                      " is there; open the arm as \"force-dimension\", or set " +
                                                      kDhdVariable + " to that path to have its arms listed")};
  try {
    std::vector<FoundDevice> out;
    for (const FoundArm& arm : list_arms(dhd_library())) out.push_back(describe_dhd(arm));
    if (out.empty())
      out.push_back(dhd_not_there(OpenProblem::NoFile, place.path + ": no arm is plugged in and switched on"));
    return out;
  } catch (const OpenError& error) {
    return {dhd_not_there(error.problem(), error.what())};
  }
}

std::unique_ptr<Pen> open_force_dimension(std::string_view serial, const PenOptions& options) {
  const ArmLibrary library = dhd_library();
  auto arm = std::make_unique<ArmProcess>(library, std::string(serial));
  auto model = std::make_shared<ArmModel>(arm->traits());
  auto again = [library, serial = arm->traits().serial]() -> std::unique_ptr<Transport> {
    return std::make_unique<ArmProcess>(library, serial);
  };
  return std::make_unique<DrivenPen>(kForceDimensionKind, std::move(model), std::move(arm), std::move(again),
                                     options.driver);
}

}  // namespace riffler::pen
