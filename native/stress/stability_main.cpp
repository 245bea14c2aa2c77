// Prints, as JSON, what docs/stability.md shows: boundaries in theory and in simulation, and sessions with and without
// the passivity controller. `docs/gallery/stability.py` draws it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "pen/arms/pens.hpp"
#include "stress/arguments.hpp"
#include "stress/identified_damping.hpp"
#include "stress/passive_bound.hpp"
#include "stress/stability.hpp"

using namespace riffler;
using namespace riffler::stress;

namespace {

constexpr double kMass = 1.5e-4;  // N·s²/mm: 150 g
constexpr double kPeriod = 1e-3;
constexpr double kStrike = 50;  // mm/s: speed at which a wall is struck for its hardness

/// A JSON array of objects, one a line.
class Rows {
 public:
  explicit Rows(const char* name) { std::printf("%s\"%s\": [", first_array ? "" : ",\n", name), first_array = false; }
  ~Rows() { std::printf("]"); }
  template <class... Values>
  void add(const char* format, Values... values) {
    std::printf("%s\n  ", first_ ? "" : ",");
    std::printf(format, values...);
    first_ = false;
  }

 private:
  static inline bool first_array = true;
  bool first_ = true;
};

void sampling() {
  Rows rows("sampling");
  for (const double b : {2.5e-4, 5e-4, 1e-3, 1.5e-3, 2e-3, 3e-3}) {
    const WallDevice device = wall_device(kMass, b);
    rows.add(R"({"damping": %.9g, "bound": %.9g, "swing": %.9g, "cunning": %.9g})", b,
             haptics::passive_stiffness({kPeriod, b, 0, 0}).least(), swing_boundary(device, {}, {1.0}),
             cunning_boundary(device, 0, {1.0}, {{1.0}}));
  }
}

void wall_damping() {
  Rows rows("wall_damping");
  for (const double wall : {-1.5e-3, -1e-3, -5e-4, 0.0, 5e-4, 1e-3, 1.5e-3}) {
    const WallDevice device = wall_device(kMass, 2e-3);
    rows.add(R"({"wall_damping": %.9g, "bound": %.9g, "cunning": %.9g})", wall,
             haptics::passive_stiffness({kPeriod, 2e-3, 0, 0}, wall).least(),
             cunning_boundary(device, wall, {1.0}, {{1.0}}));
  }
}

void quantisation() {
  Rows rows("quantisation");
  for (const double step : {0.005, 0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.3}) {
    const double damping = 2e-3, friction = 0.2;
    const WallDevice device = wall_device(kMass, damping, friction, step);
    rows.add(R"({"step": %.9g, "bound": %.9g, "cunning": %.9g})", step,
             haptics::passive_stiffness({kPeriod, damping, friction, step}).least(),
             cunning_boundary(device, 0, {1.0}, {{step}}));
  }
}

void five_coordinates() {
  Rows rows("five");
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const CoupledScene scene = coupled_scene(seed);
    Random random(seed, 1, 0);
    std::vector<Column> directions{scene.easiest};
    for (int k = 0; k < 50; ++k) {
      Column d(5);
      for (double& x : d) x = random.uniform(-1, 1);
      d[3] /= 20, d[4] /= 20;
      directions.push_back(d);
    }
    rows.add(R"({"bound": %.9g, "guided": %.9g, "free": %.9g, "cunning": %.9g})",
             haptics::passive_stiffness({kPeriod, scene.damping, 0, 0}).least(),
             swing_boundary(scene.device, guide(scene.device, scene.easiest), scene.normal),
             swing_boundary(scene.device, {}, scene.normal),
             cunning_boundary(scene.device, 0, scene.normal, directions));
  }
}

/// A hand leans on walls that are soft and walls that are far too hard, which push with 10 N at the most.
void sessions(const char* name, const WallDevice& device, const Column& normal, double bound, const WallHand& guide,
              const haptics::PassivitySettings& settings) {
  Rows rows(name);
  for (const double times : {0.25, 0.5, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 2.0, 3.0, 5.0, 8.0, 15.0, 30.0, 60.0, 100.0}) {
    const SimulatedWall wall{normal, times * bound, 0, true, 10};
    const Session session{20'000, 2, 7, false, guide};
    const SessionResult off = press(device, wall, session, {}), on = press(device, wall, session, settings);
    const double hard_off = perceptual_hardness(device, wall, guide, kStrike, {});
    const double hard_on = perceptual_hardness(device, wall, guide, kStrike, settings);
    rows.add(R"({"times": %.9g, "stiffness": %.9g,)"
             R"( "off": {"gained": %.9g, "delivered": %.9g, "speed": %.9g, "depth": %.9g, "hardness": %.9g},)"
             R"( "on": {"gained": %.9g, "delivered": %.9g, "speed": %.9g, "depth": %.9g, "hardness": %.9g,)"
             R"( "least": %.9g, "unforeseen": %ld}})",
             times, wall.stiffness, off.gained, off.delivered, off.speed, off.depth, hard_off, on.gained, on.delivered,
             on.speed, on.depth, hard_on, on.least_energy, on.unforeseen);
  }
}

/// Ticks of 10⁵ in which the controller, with its own settings, changes a wall's force: a hand strikes at random, and
/// of the device's damping and friction none, half or all is credited.
void touched(double damping, double friction) {
  Rows rows("touched");
  const double step = 6.283185307179586 / 48'000 * 180;
  for (const double stiffness : {0.5, 1.0, 2.0, 4.0, 8.0}) {
    long ticks[3];
    for (int half = 0; half <= 2; ++half) {
      haptics::PassivitySettings settings;
      settings.resolution.linear = step;
      settings.device_damping.linear = 0.5 * half * damping, settings.device_friction.linear = 0.5 * half * friction;
      const SimulatedWall wall{{1.0}, stiffness, 1e-3, true, 10};
      ticks[half] = press(wall_device(kMass, damping, friction, step), wall, {100'000, 2, 3}, settings).touched;
    }
    rows.add(R"({"stiffness": %.9g, "none": %ld, "half": %ld, "all": %ld})", stiffness, ticks[0], ticks[1], ticks[2]);
  }
}

void pen_row(Rows& rows, const char* place, double step, double damping, double friction) {
  const haptics::PassiveStiffness k = haptics::passive_stiffness({kPeriod, damping, friction, step});
  rows.add(
      R"({"place": "%s", "step": %.9g, "damping": %.9g, "friction": %.9g, "sampling": %.9g, "quantisation": %.9g})",
      place, step, damping, friction, k.sampling, k.quantisation);
}

/// The shipped pen: steps of its encoders, 48 000 and 70 000 counts a turn on arms of 180 mm, at the end of an arm.
void shipped_pen(double damping, double friction) {
  struct Place {
    const char* name;
    double step;
  };
  constexpr double kTurn = 6.283185307179586;
  Rows rows("pen");
  for (const Place& p : {Place{"arm, end of one link (48000 counts, 180 mm)", kTurn / 48'000 * 180},
                         Place{"arm, about Z, home (70000 counts, 180 mm)", kTurn / 70'000 * 180},
                         Place{"arm, about Z, stretched (70000 counts, 360 mm)", kTurn / 70'000 * 360},
                         Place{"middle of the grip, one joint of six", 0.5 * kTurn / 48'000 * 180}}) {
    pen_row(rows, p.name, p.step, damping, friction);
  }
}

/// An identified pen: the damping of its grip by posture, in the direction that is damped least.
void identified_pen(const IdentifiedDamping& pen) {
  Rows rows("pen");
  const auto row = [&](const char* place, double b) { pen_row(rows, place, pen.step, b, pen.friction); };
  const std::string of = " of " + std::to_string(pen.postures) + " postures";
  row("home posture", pen.home);
  row(("median" + of).c_str(), pen.median);
  row(("worst" + of).c_str(), pen.worst);
}

struct Arguments {
  std::string geometry;
  double damping = 2e-3, friction = 0.2;
  bool pen_only = false, help = false;
};

Arguments parse(int argc, char** argv) {
  Arguments out;
  each_option(argc, argv, [&](std::string_view option, const char* value) {
    if (option == "--pen") return out.pen_only = true, Takes::Flag;
    if (option == "--help") return out.help = true, Takes::Flag;
    if (option == "--geometry")
      out.geometry = value == nullptr ? "" : value;
    else if (option == "--damping")
      out.damping = number(option, value);
    else if (option == "--friction")
      out.friction = number(option, value);
    else
      return Takes::Unknown;
    return Takes::Value;
  });
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = parse(argc, argv);
    if (arguments.help) {
      std::puts(
          "riffler_stability [--pen] [--damping N·s/mm] [--friction N] [--geometry PEN]\n"
          "  --pen       the table of the pen alone\n"
          "  --geometry  as --pen, of an identified pen, by posture: a name or a .toml file");
      return 0;
    }
    const double damping = arguments.damping, friction = arguments.friction;
    std::optional<IdentifiedDamping> identified;  // before anything is printed
    if (!arguments.geometry.empty()) identified = identified_damping(pen::load_pen(arguments.geometry));
    std::printf("{");
    if (identified)
      identified_pen(*identified);
    else
      shipped_pen(damping, friction);
    if (!arguments.pen_only && !identified) {
      sampling(), wall_damping(), quantisation(), five_coordinates(), touched(damping, friction);
      haptics::PassivitySettings settings;
      settings.jitter = 0;
      settings.acceleration = {9e4, 0}, settings.resolution = {0, 0}, settings.device_damping = {2e-3, 0};
      sessions("one_session", wall_device(kMass, 2e-3), {1.0}, 4, {}, settings);
      const CoupledScene scene = coupled_scene(3);
      settings.acceleration = {2e5, 1e4}, settings.device_damping = {0, 0};
      sessions("five_session", scene.device, scene.normal, 2 * scene.damping / kPeriod,
               guide(scene.device, scene.easiest), settings);
    }
    std::printf("}\n");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "riffler_stability: %s\n", e.what());
    return 2;
  }
}
