#include "arm_program/hd_arm.hpp"

#include <array>
#include <utility>

#include "base/steady_clock.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::arm_program {
namespace {

using base::steady_seconds;
using pen::OpenError;
using pen::OpenProblem;

// hdDefines.h.
enum HdName : unsigned {
  kHdButtons = 0x2000,
  kHdPosition = 0x2050,
  kHdVelocity = 0x2051,
  kHdTransform = 0x2052,
  kHdModel = 0x2501,
  kHdSerial = 0x2504,
  kHdWorkspace = 0x2551,
  kHdCalibrationStyle = 0x2555,
  kHdMaxForce = 0x2603,
  kHdContinuousForce = 0x2604,
  kHdForce = 0x2700,
  kHdForceOutput = 0x4000,
};
constexpr unsigned kHdCalibrated = 0x5000, kHdNeedsUpdate = 0x5001, kHdInvalid = 0xFFFFFFFF, kHdContinue = 1;
constexpr unsigned kHdForceErrors = 0x0200, kHdDeviceErrors = 0x0300, kHdClass = 0xFF00;
constexpr unsigned short kHdPriority = 0x7FFF;  // the default
constexpr std::uint64_t kCheckEvery = 50;       // ticks between two checks of the calibration

/// From the library's axes to Riffler's: a quarter turn about x.
Vec3 from_hd(const double* v) {
  return {v[0], -v[2], v[1]};
}

std::array<double, 3> to_hd(const Vec3& v) {
  return {v.x, v.z, -v.y};
}

std::string text_or(const char* text, const char* otherwise) {
  return text == nullptr || *text == '\0' ? otherwise : text;
}

}  // namespace

HdFunctions::HdFunctions(const SharedLibrary& library) {
  library.load(init_device, "hdInitDevice");
  library.load(disable_device, "hdDisableDevice");
  library.load(begin_frame, "hdBeginFrame");
  library.load(end_frame, "hdEndFrame");
  library.load(make_current, "hdMakeCurrentDevice");
  library.load(get_error, "hdGetError");
  library.load(get_error_string, "hdGetErrorString");
  library.load(enable, "hdEnable");
  library.load(disable, "hdDisable");
  library.load(is_enabled, "hdIsEnabled");
  library.load(get_doubles, "hdGetDoublev");
  library.load(get_integers, "hdGetIntegerv");
  library.load(get_string, "hdGetString");
  library.load(set_doubles, "hdSetDoublev");
  library.load(check_calibration, "hdCheckCalibration");
  library.load(update_calibration, "hdUpdateCalibration");
  library.load(start_scheduler, "hdStartScheduler");
  library.load(stop_scheduler, "hdStopScheduler");
  library.load(schedule, "hdScheduleAsynchronous");
  library.load(unschedule, "hdUnschedule");
}

/// Throws if the library reports an error.
void HdArm::throw_error(const char* what) const {
  const HdError error = hd_->get_error();
  if (error.code != 0)
    throw OpenError(OpenProblem::Other,
                    std::string(what) + ": " + text_or(hd_->get_error_string(error.code), "no reason given"));
}

HdArm::HdArm(std::shared_ptr<const HdFunctions> functions, const std::string& name) : hd_(std::move(functions)) {
  while (hd_->get_error().code != 0) {  // errors of an earlier arm
  }
  device_ = hd_->init_device(name.empty() ? nullptr : name.c_str());
  throw_error("the library cannot open the arm");
  if (device_ == kHdInvalid) throw OpenError(OpenProblem::NoFile, "the library finds no arm");
  traits_.name = text_or(hd_->get_string(kHdModel), "3D Systems arm");
  traits_.serial = text_or(hd_->get_string(kHdSerial), "");
  traits_.own_axis = Vec3(0, 0, 1);
  hd_->get_doubles(kHdMaxForce, &traits_.force);
  hd_->get_doubles(kHdContinuousForce, &traits_.continuous);
  // If the library gives no value, take that of the family's weakest arm.
  if (!(traits_.force > 0 && traits_.force < 100)) traits_.force = 3;
  if (!(traits_.continuous > 0 && traits_.continuous <= traits_.force)) traits_.continuous = 0.8;
  std::array<double, 6> box{};
  hd_->get_doubles(kHdWorkspace, box.data());
  const Vec3 a = from_hd(box.data()), b = from_hd(box.data() + 3);
  traits_.lower = glm::min(a, b), traits_.upper = glm::max(a, b);
  traits_.about = "by OpenHaptics";
  while (hd_->get_error().code != 0) {  // from queries that it does not support
  }
}

HdArm::~HdArm() {
  if (enabled_) {
    hd_->stop_scheduler();
    hd_->unschedule(scheduled_);
    hd_->disable(kHdForceOutput);
  }
  hd_->disable_device(device_);
}

void HdArm::enable() {
  hd_->make_current(device_);
  hd_->enable(kHdForceOutput);
  throw_error("the library cannot switch on the force");
  scheduled_ = hd_->schedule(&HdArm::serve, this, kHdPriority);
  enabled_ = true;
  hd_->start_scheduler();
  throw_error("the library's scheduler does not start");
}

unsigned HdArm::serve(void* arm) noexcept {
  static_cast<HdArm*>(arm)->tick();
  return kHdContinue;
}

/// Checks calibration, errors, and whether the force is on. Runs on the library's thread.
void HdArm::check() noexcept {
  const HdError error = hd_->get_error();
  const unsigned kind = error.code & kHdClass;
  if (kind == kHdDeviceErrors) next_.gone = true;
  // The arm's own limits ended the force, which must not return by itself.
  if (kind == kHdForceErrors) next_.state.fault = error.code;
  next_.state.powered = hd_->is_enabled(kHdForceOutput) != 0;
  if (next_.number % kCheckEvery != 1) return;
  const unsigned calibration = hd_->check_calibration();
  next_.state.calibrated = calibration == kHdCalibrated;
  if (calibration != kHdNeedsUpdate) return;
  int style = 0;
  hd_->get_integers(kHdCalibrationStyle, &style);
  hd_->update_calibration(static_cast<unsigned>(style));
}

/// Runs on the library's thread.
void HdArm::tick() noexcept {
  const pen::TimedCommand command = command_.get();
  const bool fresh = steady_seconds() - command.time <= kHeld;
  const std::array<double, 3> force = to_hd(fresh ? command.wrench.force : Vec3(0));
  std::array<double, 3> position{}, velocity{};
  std::array<double, 16> transform{};
  int buttons = 0;
  hd_->begin_frame(device_);
  hd_->get_doubles(kHdPosition, position.data());
  hd_->get_doubles(kHdVelocity, velocity.data());
  hd_->get_doubles(kHdTransform, transform.data());
  hd_->get_integers(kHdButtons, &buttons);
  hd_->set_doubles(kHdForce, force.data());
  hd_->end_frame(device_);
  ++next_.number;
  next_.state.fault = 0;
  next_.state.position = from_hd(position.data());
  next_.state.velocity = from_hd(velocity.data());
  for (int k = 0; k < 3; ++k) next_.state.frame[k] = from_hd(transform.data() + 4 * k);  // column by column
  next_.state.buttons = static_cast<std::uint32_t>(buttons);
  check();
  reading_.set(next_);
}

Reading HdArm::read(pen::ArmState& state) noexcept {
  const Taken taken = reading_.get();
  if (taken.gone) return Reading::Gone;
  if (taken.number == seen_) return Reading::None;
  seen_ = taken.number;
  state = taken.state;
  return Reading::New;
}

bool HdArm::push(const pen::ArmCommand& command) noexcept {
  command_.set({command, steady_seconds()});
  return !reading_.get().gone;
}

namespace {

/// The arms of the maker's configuration, by their names there.
class HdLibrary final : public Library {
 public:
  explicit HdLibrary(const std::string& path) : hd_(std::make_shared<HdFunctions>(SharedLibrary(path))) {}

  std::vector<std::string> keys(const std::string& name) override { return {name}; }
  std::unique_ptr<LibraryArm> open(const std::string& key) override { return std::make_unique<HdArm>(hd_, key); }
  bool is(const pen::ArmTraits&, const std::string&) const override { return true; }
  std::string none(const std::string&) const override { return "the library finds no arm"; }

 private:
  std::shared_ptr<const HdFunctions> hd_;
};

}  // namespace

std::unique_ptr<Library> load_hd(const std::string& path) {
  return std::make_unique<HdLibrary>(path);
}

}  // namespace riffler::arm_program
