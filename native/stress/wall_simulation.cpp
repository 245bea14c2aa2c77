#include "stress/wall_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace riffler::stress {

namespace {

/// With friction, the period is cut into so many parts, with friction's impulse at both ends of each (Strang's
/// splitting).
constexpr int kParts = 16;

template <class Six>
Six to_six(const Column& c) {
  Six out;
  for (std::size_t k = 0; k < c.size(); ++k) out[static_cast<int>(k)] = c[k];
  return out;
}

/// Exact for constant force: the exponential of the system with the force as a state that does not change.
std::pair<Matrix, Matrix> transition(const Matrix& mass, const Matrix& damping, const Matrix& stiffness, double time) {
  const int n = mass.rows();
  const Matrix mobility = inverse(mass), drag = mobility * damping, pull = mobility * stiffness;
  Matrix a(3 * n, 3 * n);
  for (int i = 0; i < n; ++i) {
    a(i, n + i) = time;
    for (int j = 0; j < n; ++j) {
      a(n + i, j) = -time * pull(i, j);
      a(n + i, n + j) = -time * drag(i, j);
      a(n + i, 2 * n + j) = time * mobility(i, j);
    }
  }
  const Matrix e = exponential(a);
  Matrix state(2 * n, 2 * n), input(2 * n, n);
  for (int i = 0; i < 2 * n; ++i) {
    for (int j = 0; j < 2 * n; ++j) state(i, j) = e(i, j);
    for (int j = 0; j < n; ++j) input(i, j) = e(i, 2 * n + j);
  }
  return {state, input};
}

}  // namespace

WallDevice wall_device(double mass, double damping, double friction, double resolution) {
  return {1e-3, Matrix::diagonal({mass}), Matrix::diagonal({damping}), {friction}, {resolution}};
}

RenderedWall::RenderedWall(const WallDevice& device, const SimulatedWall& wall,
                           const std::optional<haptics::PassivitySettings>& settings)
    : device_(device), wall_(wall), held_(wall.normal.size(), 0.0) {
  if (settings) passivity_.emplace(*settings);
  for (std::size_t k = wall.normal.size(); k < haptics::kCoordinates; ++k) capability_.push[k] = false;
}

void RenderedWall::measure(const Column& position) {
  previous_ = measured_;
  measured_ = position;
  for (std::size_t k = 0; k < position.size(); ++k)
    if (const double step = device_.resolution[k]; step > 0) measured_[k] = step * std::floor(position[k] / step + 0.5);
  if (first_) previous_ = measured_;
}

const Column& RenderedWall::sample(const Column& position) {
  measure(position);
  const double d = dot(wall_.normal, measured_), last = dot(wall_.normal, previous_);
  double force = -wall_.stiffness * d - wall_.damping * (d - last) / device_.period;
  if (wall_.one_sided && d < 0) force = 0;
  if (wall_.most > 0) force = std::clamp(force, -wall_.most, wall_.most);
  const Column before = held_;
  for (std::size_t k = 0; k < held_.size(); ++k) held_[k] = force * wall_.normal[k];
  if (passivity_) {
    Twist moved;
    for (std::size_t k = 0; k < measured_.size(); ++k) moved[static_cast<int>(k)] = measured_[k] - previous_[k];
    passivity_->observe(to_six<Wrench>(before), moved, device_.period);
    const Wrench w = passivity_->control(to_six<Wrench>(held_), capability_);
    for (std::size_t k = 0; k < held_.size(); ++k) held_[k] = w[static_cast<int>(k)];
  }
  first_ = false;
  return held_;
}

WallSimulation::WallSimulation(const WallDevice& device, const WallHand& hand, const SimulatedWall& wall,
                               const std::optional<haptics::PassivitySettings>& settings)
    : device_(device),
      hand_(hand),
      rendered_(device, wall, settings),
      rubs_(*std::max_element(device.friction.begin(), device.friction.end()) > 0),
      parts_(rubs_ ? kParts : 1) {
  const int n = device.coordinates();
  if (hand_.stiffness.rows() == 0) hand_.stiffness = Matrix(n, n);
  if (hand_.damping.rows() == 0) hand_.damping = Matrix(n, n);
  std::tie(state_, input_) =
      transition(device.mass, device.damping + hand_.damping, hand_.stiffness, device.period / parts_);
  const Column zero(static_cast<std::size_t>(n), 0.0);
  place(zero, zero);
}

void WallSimulation::place(const Column& position, const Column& velocity) {
  position_ = position, velocity_ = velocity;
}

void WallSimulation::tick(const Column& hand) {
  const Column was_measured = rendered_.measured(), was_held = rendered_.held();
  const Column& held = rendered_.sample(position_);
  if (moving_)
    for (std::size_t k = 0; k < held.size(); ++k)
      measured_delivered_ += static_cast<long double>(was_held[k]) * (rendered_.measured()[k] - was_measured[k]);
  moving_ = true;
  Column force = hand;
  for (std::size_t k = 0; k < force.size(); ++k) force[k] += held[k];
  const Column start = position_;
  const double part = device_.period / parts_;
  for (int k = 0; k < parts_; ++k) {
    rub(part / 2);
    if (sticks(force)) break;
    advance(force);
    rub(part / 2);
  }
  for (std::size_t k = 0; k < held.size(); ++k)
    delivered_ += static_cast<long double>(held[k]) * (static_cast<long double>(position_[k]) - start[k]);
}

/// At rest, and pushed by less than friction: for good, as long as the force is held.
bool WallSimulation::sticks(const Column& force) const {
  if (!rubs_) return false;
  const Column pull = hand_.stiffness * position_;
  for (std::size_t k = 0; k < force.size(); ++k)
    if (velocity_[k] != 0 || std::abs(force[k] - pull[k]) > device_.friction[k]) return false;
  return true;
}

void WallSimulation::advance(const Column& force) {
  Column x = position_;
  x.insert(x.end(), velocity_.begin(), velocity_.end());
  const Column from_state = state_ * x, from_force = input_ * force;
  const std::size_t n = position_.size();
  for (std::size_t k = 0; k < n; ++k) {
    position_[k] = from_state[k] + from_force[k];
    velocity_[k] = from_state[n + k] + from_force[n + k];
  }
}

/// Coulomb friction over `time`: the velocity that minimises ½ (v − v₀)ᵀ M (v − v₀) + time · Σ friction |v|, coordinate
/// by coordinate until nothing changes. It slows and stops, and never pushes.
void WallSimulation::rub(double time) {
  if (!rubs_) return;
  const Column start = velocity_;
  const int n = device_.coordinates();
  for (int sweep = 0; sweep < 40; ++sweep) {
    double changed = 0;
    for (int i = 0; i < n; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      double momentum = device_.mass(i, i) * start[k];
      for (int j = 0; j < n; ++j)
        if (j != i)
          momentum -=
              device_.mass(i, j) * (velocity_[static_cast<std::size_t>(j)] - start[static_cast<std::size_t>(j)]);
      const double left = std::max(0.0, std::abs(momentum) - time * device_.friction[k]);
      const double v = std::copysign(left, momentum) / device_.mass(i, i);
      changed = std::max(changed, std::abs(v - velocity_[k]));
      velocity_[k] = v;
    }
    if (changed <= 1e-15 || n == 1) return;
  }
}

double WallSimulation::mechanical_energy() const {
  return 0.5 * dot(velocity_, device_.mass * velocity_) + 0.5 * dot(position_, hand_.stiffness * position_);
}

}  // namespace riffler::stress
