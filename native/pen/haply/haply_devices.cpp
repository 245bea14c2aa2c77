#include "pen/haply/haply_devices.hpp"

#include <optional>
#include <string>
#include <utility>

#include "pen/driven_pen.hpp"
#include "pen/haply/haply_link.hpp"
#include "pen/haply/haply_model.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {
namespace {

constexpr const char* kNone = "the Inverse Service runs, and has no Inverse3; is it plugged in and switched on?";

FoundDevice not_there(OpenProblem problem, const std::string& text) {
  FoundDevice out;
  out.path = kHaplyKind;
  out.name = "Haply Inverse3";
  out.maker = "Haply";
  out.is_there = false;
  out.problem = problem;
  out.text = text;
  return out;
}

FoundDevice describe(const HaplyConnection& service, const HaplyEntry& arm) {
  FoundDevice out;
  out.path = std::string(kHaplyKind) + ":" + std::string(arm.id);
  out.name = "Inverse3";
  out.maker = "Haply";
  out.serial = arm.id;
  out.was_opened = true;
  try {
    const HaplyModel model(service.inventory, arm.id, service.version);
    out.name = model.capability().name;
    out.capability = capability_text(model.capability());
    out.about = model.about();
  } catch (const OpenError& error) {
    out.problem = error.problem();
    out.text = out.path + ": " + error.what();
  }
  return out;
}

std::unique_ptr<Pen> open_arm(HaplyConnection service, const std::string& id, std::uint16_t port,
                              const PenOptions& options) {
  auto model = std::make_shared<HaplyModel>(service.inventory, id, service.version);
  auto again = [model, port]() -> std::unique_ptr<Transport> {
    HaplyConnection next = connect_haply(port);
    model->check(next.inventory, next.version);
    return std::make_unique<HaplyLink>(std::move(next.socket));
  };
  return std::make_unique<DrivenPen>(kHaplyKind, std::move(model),
                                     std::make_unique<HaplyLink>(std::move(service.socket)), std::move(again),
                                     options.driver);
}

}  // namespace

std::vector<FoundDevice> find_haply() {
  std::vector<FoundDevice> out;
  try {
    const HaplyConnection service = connect_haply(haply_port());
    for (const HaplyEntry& entry : service.inventory.all())
      if (!entry.is_grip) out.push_back(describe(service, entry));
    if (out.empty()) out.push_back(not_there(OpenProblem::NoFile, kNone));
  } catch (const OpenError& error) {
    out.push_back(not_there(error.problem(), error.what()));
  }
  return out;
}

std::unique_ptr<Pen> open_haply(std::string_view id, const PenOptions& options) {
  const std::uint16_t port = haply_port();
  HaplyConnection service = connect_haply(port);
  if (!id.empty()) return open_arm(std::move(service), std::string(id), port, options);
  std::optional<OpenError> first;
  for (std::size_t n = 0; const HaplyEntry* const arm = service.inventory.nth(false, n); ++n) {
    try {
      const HaplyModel free(service.inventory, arm->id, service.version);
      return open_arm(std::move(service), std::string(arm->id), port, options);
    } catch (const OpenError& error) {
      if (!first) first = error;
    }
  }
  throw first.value_or(OpenError(OpenProblem::NoFile, kNone));
}

}  // namespace riffler::pen
