#include "riffler/pen/registry.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "pen/driven_pen.hpp"
#include "pen/haply/haply_devices.hpp"
#include "pen/hid/hid_choice.hpp"
#include "pen/hid/hid_handle.hpp"
#include "pen/library/dhd_devices.hpp"
#include "pen/library/hd_devices.hpp"
#include "pen/models/polhem_model.hpp"
#include "pen/models/riffler_model.hpp"
#include "pen/models/spacemouse_model.hpp"
#include "pen/simulated/random_pen.hpp"
#include "pen/simulated/simulated_device.hpp"

namespace riffler::pen {
namespace {

/// A family of HID devices.
struct HidFamily : PenFamily {
  bool (*matches)(const HidInfo& info);
  /// Whether a search for devices may open this family. False where devices of other makers share the numbers and
  /// are indistinguishable: such a device is opened only by its kind. Pushing the motors of an unknown device is
  /// no acceptable test.
  bool opened_by_search;
  std::unique_ptr<HidModel> (*make)(HidTransport& transport, const HidInfo& info, const PenOptions& options);
};

/// A family behind a program or a library of its maker. Its devices are "kind:name".
struct VendorFamily : PenFamily {
  std::vector<FoundDevice> (*find)();
  /// Opens the device of that name, or the first that opens if it is empty.
  std::unique_ptr<Pen> (*open)(std::string_view name, const PenOptions& options);
};

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

std::unique_ptr<HidModel> make_riffler(HidTransport& transport, const HidInfo&, const PenOptions& options) {
  return std::make_unique<RifflerModel>(transport, options.compensation);
}

std::unique_ptr<HidModel> make_spacemouse(HidTransport& transport, const HidInfo& info, const PenOptions& options) {
  return std::make_unique<SpaceMouseModel>(transport, info, options.rate);
}

std::unique_ptr<HidModel> make_polhem(HidTransport& transport, const HidInfo&, const PenOptions& options) {
  const PolhemGeometry* const geometry = polhem_geometry(options.geometry);
  if (geometry == nullptr)
    throw std::invalid_argument("geometry: there is no \"" + options.geometry +
                                "\"; there are woodenhaptics, polhem-1");
  return std::make_unique<PolhemModel>(transport, *geometry);
}

// A new family is one line here.
constexpr HidFamily kHidFamilies[] = {
    {{"riffler-pen", "Riffler pen, with two arms and six motors"}, is_riffler, true, make_riffler},
    {{"spacemouse", "3Dconnexion SpaceMouse, without force"}, is_spacemouse, true, make_spacemouse},
    {{"polhem", "WoodenHaptics and Polhem, with three motors"}, may_be_polhem, false, make_polhem},
};
constexpr VendorFamily kVendorFamilies[] = {
    {{kHaplyKind, "Haply Inverse3, with three motors"}, find_haply, open_haply},
    {{kForceDimensionKind, "Force Dimension omega, delta and sigma, Novint Falcon"},
     find_force_dimension,
     open_force_dimension},
    {{kTouchKind, "3D Systems Touch (Phantom Omni), with three motors"}, find_touch, open_touch},
};

/// Opens `info` and reads its identity. Throws OpenError with the path in front.
std::pair<std::unique_ptr<HidHandle>, std::shared_ptr<HidModel>> open_model(const HidFamily& family,
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

template <class Family, std::size_t N>
const Family* named(const Family (&families)[N], std::string_view kind) {
  for (const Family& family : families)
    if (kind == family.kind) return &family;
  return nullptr;
}

const HidFamily* hid_family_of(const HidInfo& info) {
  for (const HidFamily& family : kHidFamilies)
    if (family.matches(info)) return &family;
  return nullptr;
}

std::unique_ptr<Pen> open_one(const HidFamily& family, const HidInfo& info, const PenOptions& options) {
  auto [handle, model] = open_model(family, info, options);
  auto again = [model = model, address = HidAddress::of(info)] { return open_again(*model, address); };
  return std::make_unique<DrivenPen>(family.kind, std::move(model), std::move(handle), std::move(again),
                                     options.driver);
}

std::unique_ptr<Pen> open_kind(const HidFamily& family, const PenOptions& options) {
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

/// The devices of a family, without interfaces that lack the reports.
std::vector<HidInfo> devices_of(const HidFamily& family, const PenOptions& options) {
  std::vector<HidInfo> out;
  for (const HidInfo& info : list_hid()) {
    if (!family.matches(info)) continue;
    try {
      if (family.opened_by_search) open_model(family, info, options);
    } catch (const OpenError& error) {
      if (error.problem() == OpenProblem::WrongDescriptor) continue;
    }
    out.push_back(info);
  }
  return out;
}

/// Opens the one device that `which` names.
std::unique_ptr<Pen> open_chosen(const HidFamily& family, std::string_view which, const PenOptions& options) {
  const std::vector<HidInfo> all = devices_of(family, options);
  if (all.empty()) throw OpenError(OpenProblem::NoFile, std::string("no ") + family.kind + " is plugged in");
  const std::vector<std::size_t> fit = chosen(all, which);
  if (fit.size() == 1) return open_one(family, all[fit[0]], options);
  const std::string asked = std::string(family.kind) + ":" + std::string(which);
  const std::string there = "take the number, the serial number or a part of the name of one: " + numbered(all);
  if (fit.empty()) throw OpenError(OpenProblem::NoFile, asked + ": there is no such device; " + there);
  throw OpenError(OpenProblem::Ambiguous, asked + " is " + std::to_string(fit.size()) + " devices; " + there);
}

/// The path of another interface of the same device that is of this family; empty if there is none. A receiver has
/// several, of which one has the reports.
std::string other_interface(const HidFamily& family, const HidInfo& info, const PenOptions& options) {
  for (const HidInfo& other : list_hid()) {
    const bool same = other.vendor == info.vendor && other.product == info.product && other.serial == info.serial;
    if (!same || other.path == info.path || !family.matches(other)) continue;
    try {
      open_model(family, other, options);
      return other.path;
    } catch (const OpenError&) {  // not this one either
    }
  }
  return {};
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
    const HidFamily* const family = hid_family_of(info);
    if (family == nullptr)
      throw OpenError(OpenProblem::UnknownDevice,
                      info.path + ": " + info.name + " (" + info.id() + ") is not a device that Riffler knows");
    if (!family->opened_by_search)
      throw OpenError(OpenProblem::UnknownDevice,
                      info.path + ": " + info.id() +
                          " is a number that many boards have; if it is one of these, open it as \"" + family->kind +
                          "\": " + family->what);
    try {
      return open_one(*family, info, options);
    } catch (const OpenError& error) {
      if (error.problem() != OpenProblem::WrongDescriptor) throw;
      const std::string other = other_interface(*family, info, options);
      if (other.empty()) throw;
      throw OpenError(error.problem(), std::string(error.what()) + "; the interface that has the reports is " + other);
    }
  }
  HidHandle(asked, Sharing::Shared);  // throws with the reason
  throw OpenError(OpenProblem::UnknownDevice, asked.path + ": the system does not list it as a HID device");
}

FoundDevice find_hid(const HidInfo& info) {
  FoundDevice found;
  found.path = info.path, found.name = info.name, found.maker = info.maker, found.serial = info.serial;
  found.id = info.id();
  const HidFamily* const family = hid_family_of(info);
  found.family = family;
  found.was_opened = family != nullptr && family->opened_by_search;
  if (!found.was_opened) {
    found.problem = why_not_open(info, found.text);
    return found;
  }
  try {
    const auto [handle, model] = open_model(*family, info, {});
    found.capability = capability_text(model->capability());
    found.about = model->about();
  } catch (const OpenError& error) {
    found.problem = error.problem();
    found.text = error.what();
  }
  return found;
}

/// An interface without the reports is not a broken device if another one of the same device has them: it is then as
/// any other HID device, of no family.
void leave_other_interfaces(std::vector<FoundDevice>& all) {
  const auto has_reports = [&](const FoundDevice& wrong) {
    return std::any_of(all.begin(), all.end(), [&](const FoundDevice& f) {
      return f.family == wrong.family && f.was_opened && f.problem == OpenProblem::None && f.id == wrong.id &&
             f.serial == wrong.serial;
    });
  };
  for (FoundDevice& found : all) {
    if (found.problem != OpenProblem::WrongDescriptor || !has_reports(found)) continue;
    found.family = nullptr;
    found.was_opened = false;
    found.problem = OpenProblem::None;
    found.text.clear();
  }
}

/// Where there are several of a kind, what chooses each.
void give_choices(std::vector<FoundDevice>& all) {
  for (const HidFamily& family : kHidFamilies) {
    const auto of_family = [&](const FoundDevice& found) { return found.family == &family; };
    const auto counts = [&](const FoundDevice& found) {
      return of_family(found) && found.problem != OpenProblem::WrongDescriptor;
    };
    if (std::ranges::count_if(all, counts) < 2) continue;
    int number = 0;
    for (FoundDevice& found : all)
      if (counts(found)) found.choice = std::string(family.kind) + ":" + std::to_string(++number);
  }
}

std::vector<FoundDevice> find_vendor_devices() {
  std::vector<FoundDevice> out;
  for (const VendorFamily& family : kVendorFamilies)
    for (FoundDevice& found : family.find()) {
      found.family = &family;
      out.push_back(std::move(found));
    }
  return out;
}

}  // namespace

std::vector<const PenFamily*> pen_families() {
  std::vector<const PenFamily*> out;
  for (const PenFamily& family : kHidFamilies) out.push_back(&family);
  for (const PenFamily& family : kVendorFamilies) out.push_back(&family);
  return out;
}

const PenFamily* family_of(const HidInfo& info) {
  return hid_family_of(info);
}

std::vector<FoundDevice> find_devices() {
  std::vector<FoundDevice> out;
  for (const HidInfo& info : list_hid()) out.push_back(find_hid(info));
  leave_other_interfaces(out);
  give_choices(out);
  for (FoundDevice& found : find_vendor_devices())
    if (found.is_there) out.push_back(std::move(found));
  return out;
}

std::vector<FoundDevice> find_unavailable() {
  std::vector<FoundDevice> out = find_vendor_devices();
  std::erase_if(out, [](const FoundDevice& found) { return found.is_there; });
  return out;
}

std::unique_ptr<Pen> open_pen(std::string_view what, const PenOptions& options) {
  if (what == kSimulatedKind) return open_simulated(options);
  if (const HidFamily* const family = named(kHidFamilies, what)) return open_kind(*family, options);
  const std::size_t colon = std::min(what.find(':'), what.size());
  if (const HidFamily* const family = named(kHidFamilies, what.substr(0, colon)))
    return open_chosen(*family, what.substr(colon + 1), options);
  if (const VendorFamily* const family = named(kVendorFamilies, what.substr(0, colon)))
    return family->open(what.substr(std::min(colon + 1, what.size())), options);
  return open_path(what, options);
}

}  // namespace riffler::pen
