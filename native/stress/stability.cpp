#include "stress/stability.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace riffler::stress {

namespace {

constexpr double kLever = 20;  // mm: makes rad comparable with mm

Column scaled(double s, Column c) {
  for (double& x : c) x *= s;
  return c;
}

/// Smallest stiffness in [1e-6, 1e6] for which `active` holds, to 1e-4 of its value; `active` must hold for all larger
/// ones.
template <class Active>
double bisect(const Active& active) {
  double low = std::log(1e-6), high = std::log(1e6);
  if (active(std::exp(low))) return 0;
  while (high - low > 1e-4) (active(std::exp(0.5 * (low + high))) ? high : low) = 0.5 * (low + high);
  return std::exp(0.5 * (low + high));
}

bool swings_up(const WallDevice& device, const WallHand& hand, const SimulatedWall& wall) {
  constexpr int kTicks = 16'000;
  const Column zero(wall.normal.size(), 0.0);
  WallSimulation simulation(device, hand, wall);
  simulation.place(zero, inverse(device.mass) * wall.normal);
  double early = 0, late = 0;
  for (int k = 0; k < kTicks; ++k) {
    simulation.tick(zero);
    const double d = dot(wall.normal, simulation.position());
    const double energy = simulation.mechanical_energy() + 0.5 * wall.stiffness * d * d;
    if (!(energy < 1e100)) return true;
    if (k >= kTicks / 4 && k < kTicks / 2) early += energy;
    if (k >= 3 * kTicks / 4) late += energy;
  }
  return late > early;
}

}  // namespace

double swing_boundary(const WallDevice& device, const WallHand& hand, const Column& normal) {
  return bisect([&](double stiffness) { return swings_up(device, hand, {normal, stiffness}); });
}

double gained(const WallDevice& device, const SimulatedWall& wall, const Column& amplitude, int ticks) {
  const std::size_t n = amplitude.size();
  RenderedWall rendered(device, wall, {});
  Column last;
  double sum = 0;
  // Sums over the second of two rounds, when the state before the first no longer matters.
  for (int k = 0; k <= 4 * ticks; ++k) {
    const int phase = k % (2 * ticks);
    const double s = (phase <= ticks ? phase : 2 * ticks - phase) * 2.0 / ticks - 1;
    Column x(n), way(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = s * amplitude[i] + 0.5 * device.resolution[i];
    if (k > 2 * ticks) {
      for (std::size_t i = 0; i < n; ++i) way[i] = x[i] - last[i];
      sum += dot(rendered.held(), way) - dot(way, device.damping * way) / device.period;
      for (std::size_t i = 0; i < n; ++i) sum -= device.friction[i] * std::abs(way[i]);
    }
    rendered.sample(x);
    last = x;
  }
  return sum;
}

double cunning_boundary(const WallDevice& device, double wall_damping, const Column& normal,
                        const std::vector<Column>& directions) {
  // Without encoder steps the system is linear, so one amplitude is enough.
  static constexpr double kAmplitudes[] = {1, 1e-3, 0.1, 0.4, 4, 32, 1e3};
  const bool stepless = *std::max_element(device.resolution.begin(), device.resolution.end()) == 0;
  return bisect([&](double stiffness) {
    for (const Column& direction : directions)
      for (const double amplitude : std::span(kAmplitudes).first(stepless ? 1 : std::size(kAmplitudes)))
        for (const int ticks : {1, 2, 3, 4, 8, 32, 256})
          if (gained(device, {normal, stiffness, wall_damping}, scaled(amplitude, direction), ticks) > 0) return true;
    return false;
  });
}

CoupledScene coupled_scene(std::uint64_t seed) {
  Random random(seed);
  constexpr int n = 5;
  // Qᵀ Q + ½: positive definite, with eigenvalues that differ by small factors.
  const auto definite = [&](double scale) {
    Matrix q(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) q(i, j) = random.uniform(-1, 1) * std::sqrt(0.6);
    Matrix m = transposed(q) * q + 0.5 * Matrix::identity(n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) m(i, j) *= scale * (i < 3 ? 1 : kLever) * (j < 3 ? 1 : kLever);
    return m;
  };
  CoupledScene scene;
  scene.device.mass = definite(1e-4), scene.device.damping = definite(1e-3);
  scene.device.friction = scene.device.resolution = Column(n, 0.0);
  // A contact: a force and its torque about the pivot, of which two coordinates are felt.
  const Vec3 force = random.direction(), torque = glm::cross(random.uniform(5, 30) * random.direction(), force);
  scene.normal = {force.x, force.y, force.z, torque.x, torque.y};
  scene.easiest = inverse(scene.device.damping) * scene.normal;
  scene.damping = 1 / dot(scene.normal, scene.easiest);
  return scene;
}

WallHand guide(const WallDevice& device, const Column& direction) {
  // Springs against all directions but `direction`, in coordinates where rad count as lengths; far stiffer than any
  // wall here.
  const int n = device.coordinates();
  Column u = direction;
  for (int i = 3; i < n; ++i) u[static_cast<std::size_t>(i)] *= kLever;
  const double length = std::sqrt(dot(u, u));
  WallHand hand{Matrix(n, n), Matrix(n, n)};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const std::size_t a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      hand.stiffness(i, j) =
          1e4 * ((i == j) - u[a] * u[b] / (length * length)) * (i < 3 ? 1 : kLever) * (j < 3 ? 1 : kLever);
    }
  return hand;
}

namespace {

/// The hand's motion at each tick.
class Hand {
 public:
  Hand(const Session& session, const Column& normal) : session_(session), normal_(normal), random_(session.seed) {
    push_ = session.push;
  }

  Column force(long tick, const Column& x, const Column& v) {
    if (session_.strikes) {
      if (tick % 512 == 0) push_ = random_.one_in(6) ? -session_.push / 2 : random_.uniform(0.2, 1) * session_.push;
      if (tick % 8 == 0) waver_ = random_.uniform(-0.3, 0.3) * session_.push;
    }
    Column f(x.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double unit = k < 3 ? 1 : kLever * kLever;
      f[k] = (push_ + waver_) * normal_[k] - unit * (0.02 * x[k] + 1e-4 * v[k]);
    }
    return f;
  }

 private:
  const Session& session_;
  const Column& normal_;
  Random random_;
  double push_, waver_ = 0;
};

}  // namespace

SessionResult press(const WallDevice& device, const SimulatedWall& wall, const Session& session,
                    const std::optional<haptics::PassivitySettings>& settings) {
  const std::size_t n = wall.normal.size();
  WallSimulation simulation(device, session.guide, wall, settings);
  Hand hand(session, wall.normal);
  Column way(n, 0.0);
  const Column towards = inverse(device.damping) * wall.normal;
  simulation.place(scaled(-0.5 / dot(wall.normal, towards), towards), Column(n, 0.0));
  SessionResult result;
  long late = 0;
  double gained = 0;
  for (long tick = 0; tick < session.ticks; ++tick) {
    const Column force = hand.force(tick, simulation.position(), simulation.velocity());
    const Column before = simulation.rendered().held(), last = simulation.position();
    simulation.tick(force);
    const Column &held = simulation.rendered().held(), &now = simulation.position();
    const double depth = dot(wall.normal, now), speed = dot(wall.normal, simulation.velocity());
    for (std::size_t k = 0; k < n; ++k) {
      const double acceleration = (now[k] - last[k] - way[k]) / (device.period * device.period);
      if (settings && std::abs(acceleration) > settings->acceleration[static_cast<int>(k)]) ++result.unforeseen;
      way[k] = now[k] - last[k];
      result.variation += 0.5 * device.resolution[k] * std::abs(held[k] - before[k]);
    }
    gained -= dot(force, way);
    result.gained = std::max(result.gained, gained);
    result.delivered = std::max(result.delivered, static_cast<double>(simulation.delivered()));
    result.measured_delivered =
        std::max(result.measured_delivered, static_cast<double>(simulation.measured_delivered()));
    if (const haptics::Passivity* p = simulation.rendered().passivity()) {
      result.touched += p->kept() < 1 || p->damped() > 0;
      result.least_energy = tick == 0 ? p->energy() : std::min(result.least_energy, p->energy());
    }
    if (tick < session.ticks / 4 * 3) continue;
    ++late;
    result.depth += depth, result.speed += speed * speed;
  }
  result.depth /= static_cast<double>(late);
  result.speed = std::sqrt(result.speed / static_cast<double>(late));
  return result;
}

namespace {

/// One strike, with the contact `phase` periods after a sample.
double strike(const WallDevice& device, const SimulatedWall& wall, const WallHand& guide, double speed, double phase,
              const std::optional<haptics::PassivitySettings>& settings) {
  constexpr int kRun = 10, kInContact = 20;  // periods
  Column towards = inverse(device.damping) * wall.normal;
  towards = scaled(1 / dot(wall.normal, towards), towards);
  const Column zero(wall.normal.size(), 0.0);
  WallSimulation simulation(device, guide, wall, settings);
  simulation.place(scaled(-(kRun + phase) * speed * device.period, towards), scaled(speed, towards));
  double steepest = 0, last = 0, entered = 0;
  for (int contact = 0; contact < kInContact;) {
    const double depth = dot(wall.normal, simulation.position());
    if (contact == 0) entered = dot(wall.normal, simulation.velocity());
    if (!(entered > 0)) return 0;  // came to rest before the wall
    contact += contact > 0 || depth > 0;
    simulation.tick(zero);
    const double force = -dot(simulation.rendered().held(), towards);
    steepest = std::max(steepest, (force - last) / device.period);
    last = force;
  }
  return steepest / entered;
}

}  // namespace

double perceptual_hardness(const WallDevice& device, const SimulatedWall& wall, const WallHand& guide, double speed,
                           const std::optional<haptics::PassivitySettings>& settings) {
  constexpr int kPhases = 16;
  double sum = 0;
  for (int k = 0; k < kPhases; ++k) sum += strike(device, wall, guide, speed, (k + 0.5) / kPhases, settings);
  return sum / kPhases;
}

}  // namespace riffler::stress
