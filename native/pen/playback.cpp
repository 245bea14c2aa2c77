#include "riffler/pen/playback.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "pen/driver.hpp"
#include "riffler/base/check.hpp"

namespace riffler::pen {
namespace {

constexpr double kNotBegun = -std::numeric_limits<double>::infinity();

[[noreturn]] void fail(std::size_t stroke, std::size_t row, const char* what) {
  throw std::invalid_argument("stroke " + std::to_string(stroke) + ", row " + std::to_string(row) + ": " + what);
}

void check(const RecordedStroke& stroke, std::size_t number) {
  if (stroke.poses.empty()) fail(number, 0, "a stroke needs a pose");
  if (stroke.times.size() != stroke.poses.size())
    fail(number, std::min(stroke.times.size(), stroke.poses.size()), "a recording needs one time for each pose");
  for (std::size_t k = 0; k < stroke.times.size(); ++k) {
    if (!std::isfinite(stroke.times[k])) fail(number, k, "a time is not finite");
    if (!geom::finite(stroke.poses[k].tip) || !geom::finite(stroke.poses[k].axis))
      fail(number, k, "a pose is not finite");
    if (std::abs(glm::length(stroke.poses[k].axis) - 1) > 1e-6) fail(number, k, "an axis is not of unit length");
    if (k > 0 && stroke.times[k] < stroke.times[k - 1]) fail(number, k, "times fall");
    if (k > 0 && glm::length(stroke.poses[k].axis + stroke.poses[k - 1].axis) < 1e-9)
      fail(number, k, "the axis is opposite to the one before");
  }
}

}  // namespace

PlaybackPen::PlaybackPen(std::vector<RecordedStroke> strokes, double speed, std::function<double()> clock)
    : clock_(clock ? std::move(clock) : std::function<double()>(steady_seconds)), speed_(speed), start_(kNotBegun) {
  base::require_positive(speed, "speed");
  if (strokes.empty()) throw std::invalid_argument("strokes: a recording needs a stroke");
  capability_.name = "recording";
  for (std::size_t k = 0; k < 5; ++k) capability_.coordinates[k].sensing = Sensing::Position;
  capability_.turns = TurnAxes::Grip;
  const double first = strokes[0].times.empty() ? 0 : strokes[0].times[0];
  double shift = -first;
  for (std::size_t s = 0; s < strokes.size(); ++s) {
    check(strokes[s], s);
    const double end = rows_.empty() ? 0 : rows_.back().time;
    if (strokes[s].times[0] + shift < end) shift = end - strokes[s].times[0];
    for (std::size_t k = 0; k < strokes[s].poses.size(); ++k)
      rows_.push_back({strokes[s].times[k] + shift, strokes[s].poses[k], k + 1 == strokes[s].poses.size()});
  }
}

std::string PlaybackPen::about() const {
  return std::to_string(rows_.size()) + " poses";
}

double PlaybackPen::elapsed() const noexcept {
  double start = kNotBegun;
  const double now = clock_();
  // The first call starts the playback.
  if (start_.compare_exchange_strong(start, now)) return 0;
  return speed_ * (now - start);
}

PenSample PlaybackPen::newest() const noexcept {
  const double t = std::max(elapsed(), 0.0);
  const auto next =
      std::upper_bound(rows_.begin(), rows_.end(), t, [](double time, const Row& r) { return time < r.time; });
  const Row& last = *(next - 1);  // the first row's time is 0
  PenSample out;
  out.sequence = static_cast<std::uint64_t>(next - rows_.begin());
  out.time = clock_();
  out.homed = true;
  out.pose = last.pose;
  if (next == rows_.end() || last.ends) return out;
  out.buttons = 1;
  const Motion motion(last.pose, next->pose);
  const double dt = next->time - last.time;
  out.pose = motion.at((t - last.time) / dt);
  out.velocity = speed_ / dt * (next->pose.tip - last.pose.tip);
  out.turning = speed_ / dt * motion.rotation();
  return out;
}

LinkStatus PlaybackPen::status() const noexcept {
  LinkStatus out = Pen::status();
  if (out.sample.sequence == rows_.size()) out.state = LinkState::Stopped;
  return out;
}

}  // namespace riffler::pen
