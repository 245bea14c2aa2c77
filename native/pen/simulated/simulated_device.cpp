#include "pen/simulated/simulated_device.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "pen/models/riffler_model.hpp"
#include "pen/simulated/simulated_transport.hpp"
#include "riffler/base/check.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {

namespace {

constexpr double kStall = 5e-4;  // s by which StallTolerantClock may advance between two reads

/// A clock that advances only by waiting.
StallTolerantClock::System as_fast_as_possible() {
  const auto time = std::make_shared<double>(0);
  return {[time] { return *time; }, [time](double seconds) { *time += seconds; }};
}

}  // namespace

/// The hand's commanded target and its autonomous motion.
struct SimulatedDevice::Hand {
  struct Told {
    HandWish wish{};
    bool wanders = true;
  };
  Published<Told> told;
  HandPath curve;

  HandWish wish(double seconds) const {
    const Told now = told.get();
    return now.wanders ? curve(seconds) : now.wish;
  }
};

/// The counts that encoders are commanded to lose, and have lost.
struct SimulatedDevice::Losses {
  std::array<std::atomic<std::int32_t>, kPenChannels> told{};
  std::array<std::int32_t, kPenChannels> gone{};  // used by the thread that moves the pen

  /// Removes one count of each per turn of the firmware: all at once would look like a speed.
  void take(riffler_pen_sensors& sensors) {
    for (std::size_t k = 0; k < kPenChannels; ++k) {
      const std::int32_t wanted = told[k].load(std::memory_order_relaxed);
      gone[k] += (wanted > gone[k]) - (wanted < gone[k]);
      sensors.counters[k] -= gone[k];
    }
  }
};

/// What hangs on the pen: a weight on its grip, and its cable.
struct SimulatedDevice::Load {
  struct Told {
    double mass = 0, hook = 0;
  };
  Published<Told> told;
  std::atomic<bool> plugged{true};

  void turn(SimulatedPen& pen) {
    const Told now = told.get();
    pen.weight().hang(now.mass, now.hook);
    connect(pen);
  }
  void connect(SimulatedPen& pen) {
    const bool wanted = plugged.load(std::memory_order_relaxed);
    if (wanted == pen.plugged()) return;
    if (wanted)
      pen.plug();
    else
      pen.unplug();
  }
};

std::unique_ptr<SimulatedDevice> SimulatedDevice::open(const SimulatedPenSettings& settings,
                                                       const DriverSettings& driver,
                                                       const CompensationShares& compensation, bool real_time) {
  auto hand = std::make_shared<Hand>();
  auto pen = std::make_shared<SimulatedPen>(settings);
  hand->curve = hand_on_a_curve(pen->arms().posture().pose);
  pen->hand().follow([hand](double seconds) { return hand->wish(seconds); });
  auto losses = std::make_shared<Losses>();
  pen->on_sense = [losses](riffler_pen_sensors& sensors) { losses->take(sensors); };
  auto load = std::make_shared<Load>();
  pen->on_turn = [load, pen = pen.get()] { load->turn(*pen); };
  const auto clock = real_time ? std::make_shared<StallTolerantClock>()
                               : std::make_shared<StallTolerantClock>(kStall, as_fast_as_possible());
  const double start = clock->now();
  auto transport = std::make_unique<SimulatedTransport>(pen, clock, start);
  auto model = std::make_shared<RifflerModel>(*transport, compensation);
  // It starts in its home posture, and the hand rests there for longer than the first report takes.
  model->home();
  auto again = [pen, clock, start, model, load]() -> std::unique_ptr<Transport> {
    load->connect(*pen);  // nothing advances a pen without a transport
    if (!pen->plugged()) throw OpenError(OpenProblem::NoFile, "the simulated pen is unplugged; plug it in again");
    auto next = std::make_unique<SimulatedTransport>(pen, clock, start);
    model->check(*next);
    return next;
  };
  DriverSettings driving = driver;
  driving.real_time = driving.real_time && real_time;  // a clock that does not wait would take the machine
  return std::unique_ptr<SimulatedDevice>(new SimulatedDevice(settings.geometry, std::move(hand), std::move(losses),
                                                              std::move(load), std::move(model), std::move(transport),
                                                              std::move(again), driving, clock));
}

SimulatedDevice::SimulatedDevice(const PenGeometry& truth, std::shared_ptr<Hand> hand, std::shared_ptr<Losses> losses,
                                 std::shared_ptr<Load> load, std::shared_ptr<PenModel> model,
                                 std::unique_ptr<Transport> transport, Driver::Open open, const DriverSettings& driver,
                                 std::shared_ptr<StallTolerantClock> clock)
    : DrivenPen(kSimulatedKind, std::move(model), std::move(transport), std::move(open), driver, clock),
      truth_(truth),
      hand_(std::move(hand)),
      losses_(std::move(losses)),
      load_(std::move(load)),
      clock_(std::move(clock)) {}

void SimulatedDevice::aim(const HandWish& wish) {
  HandWish checked = wish;
  const double length = glm::length(wish.pose.axis);
  if (!geom::finite(wish.pose.tip)) throw std::invalid_argument("pose: the point must be finite");
  if (!std::isfinite(length) || length == 0) throw std::invalid_argument("pose: the axis must be finite, not zero");
  base::require(std::isfinite(wish.spin), "spin", "must be finite");
  base::require_between(wish.grip, 0, 1, "grip");
  checked.pose.axis /= length;
  hand_->told.set({checked, false});
}

void SimulatedDevice::wander() noexcept {
  hand_->told.set({{}, true});
}

void SimulatedDevice::lose(std::size_t channel, std::int32_t counts) {
  if (channel >= kPenChannels) throw std::invalid_argument("channel must be 0 to 5, not " + std::to_string(channel));
  losses_->told[channel].store(counts, std::memory_order_relaxed);
}

void SimulatedDevice::hang(double mass, double hook) {
  SimulatedWeight().hang(mass, hook);  // checks
  load_->told.set({mass, hook});
}

void SimulatedDevice::unplug() noexcept {
  load_->plugged.store(false, std::memory_order_relaxed);
}

void SimulatedDevice::plug() noexcept {
  load_->plugged.store(true, std::memory_order_relaxed);
}

}  // namespace riffler::pen
