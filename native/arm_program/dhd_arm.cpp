#include "arm_program/dhd_arm.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "base/steady_clock.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::arm_program {
namespace {

using base::steady_seconds;
using pen::OpenError;
using pen::OpenProblem;

// dhdc.h; the array of the status may grow in later versions.
enum DhdStatus : std::size_t { kPower = 0, kConnected = 1, kReset = 3, kForce = 5, kError = 9, kForceOffCause = 14 };
constexpr std::size_t kStatusRoom = 64;
constexpr double kStatusPeriod = 0.02;  // s: the status is another message on the cable

// Largest force and torque requested of an arm: below what the maker states for the weakest arm of each family in every
// posture. The torque applies to wrists with motors.
constexpr double kDhdForce = 8, kDhdTorque = 150;  // N, N·mm

/// From the library's axes to Riffler's: a quarter turn about z.
Vec3 from_dhd(double x, double y, double z) {
  return {y, -x, z};
}

Vec3 to_dhd(const Vec3& v) {
  return {-v.y, v.x, v.z};
}

}  // namespace

DhdFunctions::DhdFunctions(const SharedLibrary& library) {
  library.load(get_device_count, "dhdGetDeviceCount");
  library.load(open_id, "dhdOpenID");
  library.load(close, "dhdClose");
  library.load(get_system_name, "dhdGetSystemName");
  library.load(get_serial_number, "dhdGetSerialNumber");
  library.load(get_status, "dhdGetStatus");
  library.load(has_wrist, "dhdHasWrist");
  library.load(has_active_wrist, "dhdHasActiveWrist");
  library.load(get_button_mask, "dhdGetButtonMask");
  library.load(get_position, "dhdGetPosition");
  library.load(get_linear_velocity, "dhdGetLinearVelocity");
  library.load(get_orientation_frame, "dhdGetOrientationFrame");
  library.load(enable_force, "dhdEnableForce");
  library.load(set_force, "dhdSetForceAndTorqueAndGripperForce");
  library.load_optional(set_watchdog, "dhdSetWatchdog");
  library.load(get_last_error, "dhdErrorGetLastStr");
}

void DhdArm::fail(const char* what) const {
  const char* const why = dhd_->get_last_error();
  throw OpenError(OpenProblem::Other, std::string(what) + ": " + (why == nullptr ? "no reason given" : why));
}

DhdArm::DhdArm(std::shared_ptr<const DhdFunctions> functions, int number) : dhd_(std::move(functions)) {
  const int id = dhd_->open_id(static_cast<char>(number));
  if (id < 0) fail("the library cannot open the arm");
  id_ = static_cast<char>(id);
  const char* const name = dhd_->get_system_name(id_);
  traits_.name = name == nullptr ? "Force Dimension arm" : name;
  unsigned short serial = 0;
  if (dhd_->get_serial_number(&serial, id_) >= 0) traits_.serial = std::to_string(serial);
  const bool wrist = dhd_->has_wrist(id_), active = dhd_->has_active_wrist(id_);
  traits_.own_axis = wrist ? Vec3(1, 0, 0) : Vec3(0);
  traits_.force = traits_.continuous = kDhdForce;
  traits_.torque = active ? kDhdTorque : 0;
  traits_.about = std::string("by libdhd; ") + (active  ? "a wrist with motors"
                                                : wrist ? "a wrist without motors"
                                                        : "no wrist: the tool keeps its axis");
}

DhdArm::~DhdArm() {
  if (enabled_) {
    dhd_->set_force(0, 0, 0, 0, 0, 0, 0, id_);
    dhd_->enable_force(0, id_);
  }
  dhd_->close(id_);
}

void DhdArm::enable() {
  if (dhd_->set_force(0, 0, 0, 0, 0, 0, 0, id_) < 0) fail("the library does not take a force");
  if (dhd_->enable_force(1, id_) < 0) fail("the library cannot switch on the force");
  enabled_ = true;
  // The library refuses this for an arm without a watchdog.
  if (dhd_->set_watchdog != nullptr) dhd_->set_watchdog(static_cast<unsigned char>(kWatchdog / 125e-6), id_);
}

/// Reads the arm's status. False if it has been unplugged.
bool DhdArm::read_status() noexcept {
  std::array<int, kStatusRoom> status{};
  if (dhd_->get_status(status.data(), id_) < 0) return false;
  state_.calibrated = status[kReset] == 0;
  state_.powered = status[kPower] != 0 && status[kForce] != 0;
  state_.fault = status[kError] != 0 ? 1 : 0;
  return status[kConnected] != 0;
}

double DhdArm::due() const noexcept {
  return next_ - steady_seconds();
}

Reading DhdArm::read(pen::ArmState& state) noexcept {
  const double now = steady_seconds();
  if (now < next_) return Reading::None;
  next_ = std::max(next_ + kPeriod, now);
  std::array<double, 3> p{}, v{};
  double frame[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (dhd_->get_position(&p[0], &p[1], &p[2], id_) < 0) return Reading::Gone;
  if (dhd_->get_linear_velocity(&v[0], &v[1], &v[2], id_) < 0) return Reading::Gone;
  if (traits_.own_axis != Vec3(0) && dhd_->get_orientation_frame(frame, id_) < 0) return Reading::Gone;
  if (now >= status_due_) {
    if (!read_status()) return Reading::Gone;
    status_due_ = now + kStatusPeriod;
  }
  constexpr double kMillimetres = 1000;  // in a metre
  state_.position = kMillimetres * from_dhd(p[0], p[1], p[2]);
  state_.velocity = kMillimetres * from_dhd(v[0], v[1], v[2]);
  for (int k = 0; k < 3; ++k) state_.frame[k] = from_dhd(frame[0][k], frame[1][k], frame[2][k]);
  state_.buttons = dhd_->get_button_mask(id_);
  state = state_;
  return Reading::New;
}

bool DhdArm::push(const pen::ArmCommand& command) noexcept {
  constexpr double kNewtonMetres = 1e-3;  // in a N·mm
  const Vec3 f = to_dhd(command.force), t = kNewtonMetres * to_dhd(command.torque);
  return dhd_->set_force(f.x, f.y, f.z, t.x, t.y, t.z, 0, id_) >= 0;
}

namespace {

/// The library's arms, numbered from 0; their names are serial numbers.
class DhdLibrary final : public Library {
 public:
  explicit DhdLibrary(const std::string& path) : dhd_(std::make_shared<DhdFunctions>(SharedLibrary(path))) {}

  std::vector<std::string> keys(const std::string&) override {
    std::vector<std::string> out;
    for (int number = 0, count = dhd_->get_device_count(); number < count; ++number)
      out.push_back(std::to_string(number));
    return out;
  }
  std::unique_ptr<LibraryArm> open(const std::string& key) override {
    return std::make_unique<DhdArm>(dhd_, std::stoi(key));
  }
  bool is(const pen::ArmTraits& traits, const std::string& name) const override {
    return name.empty() || traits.serial == name;
  }
  std::string none(const std::string& name) const override {
    return name.empty() ? "no arm is plugged in and switched on"
                        : "no arm with the serial number " + name + " is plugged in";
  }

 private:
  std::shared_ptr<const DhdFunctions> dhd_;
};

}  // namespace

std::unique_ptr<Library> load_dhd(const std::string& path) {
  return std::make_unique<DhdLibrary>(path);
}

}  // namespace riffler::arm_program
