#include "pen/library/dhd_devices.hpp"

#include <optional>
#include <string>
#include <utility>

#include "pen/driven_pen.hpp"
#include "pen/library/arm_model.hpp"
#include "pen/library/dhd_library.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {
namespace {

constexpr const char* kDhdVariable = "RIFFLER_LIBDHD";
constexpr const char* kInstallDhd =
    "install Force Dimension's SDK (https://www.forcedimension.com/software/sdk) and set RIFFLER_LIBDHD to the whole "
    "path of its libdhd.so";

std::shared_ptr<const DhdFunctions> load_dhd() {
  const LibraryPlace place = find_library(kDhdVariable, {"libdhd.so.3", "libdhd.so"});
  if (place.path.empty()) throw OpenError(OpenProblem::NotInstalled, std::string("there is no libdhd; ") + kInstallDhd);
  try {
    return std::make_shared<DhdFunctions>(SharedLibrary(place.path));
  } catch (const OpenError& error) {
    throw OpenError(error.problem(), std::string(error.what()) + "; " + kInstallDhd);
  }
}

/// Opens the arm with that serial number (empty: any) without force. Throws the error of the first that does not open.
std::unique_ptr<DhdArm> open_dhd(const std::shared_ptr<const DhdFunctions>& dhd, std::string_view serial) {
  std::optional<OpenError> first;
  const int count = dhd->get_device_count();
  for (int number = 0; number < count; ++number) {
    try {
      auto arm = std::make_unique<DhdArm>(dhd, number);
      if (serial.empty() || arm->traits().serial == serial) return arm;
    } catch (const OpenError& error) {
      if (!first) first = error;
    }
  }
  if (first) throw OpenError(first->problem(), first->what());
  throw OpenError(OpenProblem::NoFile, serial.empty()
                                           ? "no arm is plugged in and switched on"
                                           : "no arm with the serial number " + std::string(serial) + " is plugged in");
}

FoundDevice describe_dhd(const std::shared_ptr<const DhdFunctions>& dhd, int number) {
  FoundDevice out;
  out.path = std::string(kForceDimensionKind) + ":";
  out.name = "Force Dimension arm";
  out.maker = "Force Dimension";
  out.was_opened = true;
  try {
    const DhdArm arm(dhd, number);
    const ArmModel model(arm.traits());
    out.path += arm.traits().serial;
    out.name = arm.traits().name;
    out.serial = arm.traits().serial;
    out.capability = capability_text(model.capability());
    out.about = model.about();
  } catch (const OpenError& error) {
    out.path = kForceDimensionKind;
    out.problem = error.problem();
    out.text = "arm " + std::to_string(number) + ": " + error.what();
  }
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
  const LibraryPlace place = find_library(kDhdVariable, {"libdhd.so.3", "libdhd.so"});
  if (!place.path.empty() && !place.chosen)
    return {dhd_not_there(OpenProblem::NotChosen, place.path +
                                                      " is there; open the arm as \"force-dimension\", or set " +
                                                      kDhdVariable + " to that path to have its arms listed")};
  try {
    const std::shared_ptr<const DhdFunctions> dhd = load_dhd();
    std::vector<FoundDevice> out;
    const int count = dhd->get_device_count();
    for (int number = 0; number < count; ++number) out.push_back(describe_dhd(dhd, number));
    if (out.empty())
      out.push_back(dhd_not_there(OpenProblem::NoFile, place.path + ": no arm is plugged in and switched on"));
    return out;
  } catch (const OpenError& error) {
    return {dhd_not_there(error.problem(), error.what())};
  }
}

std::unique_ptr<Pen> open_force_dimension(std::string_view serial, const PenOptions& options) {
  const std::shared_ptr<const DhdFunctions> dhd = load_dhd();
  std::unique_ptr<DhdArm> arm = open_dhd(dhd, serial);
  arm->enable();
  auto model = std::make_shared<ArmModel>(arm->traits());
  auto again = [dhd, serial = arm->traits().serial]() -> std::unique_ptr<Transport> {
    std::unique_ptr<DhdArm> next = open_dhd(dhd, serial);
    next->enable();
    return next;
  };
  return std::make_unique<DrivenPen>(kForceDimensionKind, std::move(model), std::move(arm), std::move(again),
                                     options.driver);
}

}  // namespace riffler::pen
