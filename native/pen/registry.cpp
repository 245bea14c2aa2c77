#include "riffler/pen/registry.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include "pen/hid/hid_handle.hpp"
#include "pen/hid_pen.hpp"
#include "pen/models/polhem_model.hpp"
#include "pen/models/riffler_model.hpp"
#include "pen/models/spacemouse_model.hpp"
#include "pen/simulated/random_pen.hpp"
#include "pen/simulated/simulated_device.hpp"

namespace riffler::pen {
namespace {

bool is_riffler(const HidInfo& info) {
  return info.vendor == RIFFLER_PEN_VENDOR_ID && info.product == RIFFLER_PEN_PRODUCT_ID &&
         (info.name.find(RIFFLER_PEN_PRODUCT) != std::string::npos ||
          info.has_usage(RIFFLER_PEN_USAGE_PAGE, RIFFLER_PEN_USAGE));
}

bool is_spacemouse(const HidInfo& info) {
  constexpr std::uint16_t kGenericDesktop = 1, kMultiAxis = 8;
  // Among a receiver's interfaces, the one with the puck; all interfaces of a device without usages.
  return spacemouse_name(info.vendor, info.product) != nullptr &&
         (info.usages.empty() || info.has_usage(kGenericDesktop, kMultiAxis));
}

/// Teensy boards as "raw HID", and mbed's default, as in the published firmware: numbers that many devices share.
bool may_be_polhem(const HidInfo& info) {
  const bool teensy =
      info.vendor == 0x16C0 && info.product == 0x0486 && (info.usages.empty() || info.has_usage(0xFFAB, 0x0200));
  return teensy || (info.vendor == 0x1234 && info.product == 0x0006);
}

std::unique_ptr<HidModel> make_riffler(Transport& transport, const HidInfo&, const PenOptions& options) {
  return std::make_unique<RifflerModel>(transport, options.compensation);
}

std::unique_ptr<HidModel> make_spacemouse(Transport& transport, const HidInfo& info, const PenOptions& options) {
  return std::make_unique<SpaceMouseModel>(transport, info, options.rate);
}

std::unique_ptr<HidModel> make_polhem(Transport& transport, const HidInfo&, const PenOptions& options) {
  const PolhemGeometry* const geometry = polhem_geometry(options.geometry);
  if (geometry == nullptr)
    throw std::invalid_argument("geometry: there is no \"" + options.geometry +
                                "\"; there are woodenhaptics, polhem-1");
  return std::make_unique<PolhemModel>(transport, *geometry);
}

// A new family is one line here.
constexpr PenFamily kFamilies[] = {
    {"riffler-pen", "Riffler pen, with two arms and six motors", is_riffler, true, make_riffler},
    {"spacemouse", "3Dconnexion SpaceMouse, without force", is_spacemouse, true, make_spacemouse},
    {"polhem", "WoodenHaptics and Polhem, with three motors", may_be_polhem, false, make_polhem},
};

/// Opens `info` and reads its identity. Throws OpenError with the path in front.
std::pair<std::unique_ptr<HidHandle>, std::shared_ptr<HidModel>> open_model(const PenFamily& family,
                                                                            const HidInfo& info,
                                                                            const PenOptions& options) {
  auto handle = std::make_unique<HidHandle>(info);
  try {
    std::shared_ptr<HidModel> model = family.make(*handle, info, options);
    return {std::move(handle), std::move(model)};
  } catch (const OpenError& error) {
    throw OpenError(error.problem(), info.path + ": " + error.what());
  }
}

std::unique_ptr<Transport> open_again(HidModel& model, const HidAddress& address) {
  const std::vector<HidInfo> found = list_hid();
  const HidInfo* const info = find_again(found, address);
  if (info == nullptr) throw OpenError(OpenProblem::NoFile, "it is not plugged in");
  auto handle = std::make_unique<HidHandle>(*info);
  model.check(*handle);
  return handle;
}

const PenFamily* family_named(std::string_view kind) {
  for (const PenFamily& family : kFamilies)
    if (kind == family.kind) return &family;
  return nullptr;
}

std::unique_ptr<Pen> open_one(const PenFamily& family, const HidInfo& info, const PenOptions& options) {
  auto [handle, model] = open_model(family, info, options);
  auto again = [model = model, address = HidAddress::of(info)] { return open_again(*model, address); };
  return std::make_unique<HidPen>(family.kind, std::move(model), std::move(handle), std::move(again), options.driver);
}

std::unique_ptr<Pen> open_kind(const PenFamily& family, const PenOptions& options) {
  std::optional<OpenError> first;
  for (const HidInfo& info : list_hid()) {
    if (!family.matches(info)) continue;
    try {
      return open_one(family, info, options);
    } catch (const OpenError& error) {
      if (!first) first = error;
    }
  }
  throw first.value_or(OpenError(OpenProblem::NoFile, std::string("no ") + family.kind + " is plugged in"));
}

std::unique_ptr<Pen> open_simulated(const PenOptions& options) {
  SimulatedPenSettings settings;
  if (options.seed) settings.geometry = random_pen(settings.geometry, *options.seed);
  return SimulatedDevice::open(settings, options.driver, options.compensation, options.real_time);
}

std::unique_ptr<Pen> open_path(std::string_view path, const PenOptions& options) {
  HidInfo asked;
  asked.path = path;
  for (const HidInfo& info : list_hid()) {
    if (info.path != path) continue;
    const PenFamily* const family = family_of(info);
    if (family == nullptr)
      throw OpenError(OpenProblem::UnknownDevice,
                      info.path + ": " + info.name + " (" + info.id() + ") is no device that Riffler knows");
    if (!family->opened_by_search)
      throw OpenError(OpenProblem::UnknownDevice,
                      info.path + ": " + info.id() +
                          " is a number that many boards have; if it is one of these, open it as \"" + family->kind +
                          "\": " + family->what);
    return open_one(*family, info, options);
  }
  HidHandle(asked, Sharing::Shared);  // throws with the reason
  throw OpenError(OpenProblem::UnknownDevice, asked.path + ": the system does not list it as a HID device");
}

}  // namespace

std::span<const PenFamily> pen_families() {
  return kFamilies;
}

const PenFamily* family_of(const HidInfo& info) {
  for (const PenFamily& family : kFamilies)
    if (family.matches(info)) return &family;
  return nullptr;
}

std::vector<FoundDevice> find_devices() {
  std::vector<FoundDevice> out;
  for (HidInfo& info : list_hid()) {
    FoundDevice& found = out.emplace_back();
    found.info = std::move(info);
    found.family = family_of(found.info);
    found.was_opened = found.family != nullptr && found.family->opened_by_search;
    if (!found.was_opened) {
      found.problem = why_not_open(found.info, found.text);
      continue;
    }
    try {
      const auto [handle, model] = open_model(*found.family, found.info, {});
      found.capability = capability_text(model->capability());
      found.about = model->about();
    } catch (const OpenError& error) {
      found.problem = error.problem();
      found.text = error.what();
    }
  }
  return out;
}

std::unique_ptr<Pen> open_pen(std::string_view what, const PenOptions& options) {
  if (what == kSimulatedKind) return open_simulated(options);
  if (const PenFamily* const family = family_named(what)) return open_kind(*family, options);
  return open_path(what, options);
}

}  // namespace riffler::pen
