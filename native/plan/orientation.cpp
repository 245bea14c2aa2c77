#include "riffler/plan/orientation.hpp"

#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/directions.hpp"
#include "geom/math.hpp"
#include "plan/smooth_axes.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/plan/cc_frame.hpp"

namespace riffler::plan {

namespace {

constexpr const char* kInterpolationNames[] = {"linear", "slerp", "smooth"};

[[noreturn]] void refuse(std::size_t point, const std::string& what) {
  throw std::invalid_argument("keys, point " + std::to_string(point) + ": " + what);
}

OrientationKeys checked(const PencilPath& path, const OrientationKeys& keys) {
  OrientationKeys out;
  for (const auto& [k, axis] : keys) {
    if (k >= path.size()) refuse(k, "the path has " + std::to_string(path.size()) + " points");
    out[k] = unit_axis(axis, "keys, point " + std::to_string(k));
  }
  return out;
}

/// Arc length up to every point, and to the end of a closed path.
std::vector<double> stations(const PencilPath& path) {
  std::vector<double> out{0};
  for (std::size_t k = 1; k < path.size(); ++k)
    out.push_back(out.back() + glm::length(path.centres[k] - path.centres[k - 1]));
  out.push_back(path.closed ? path.length() : out.back());
  return out;
}

/// From key `from` to key `to`, in an index that keeps counting past the end of a closed path.
struct KeySpan {
  std::size_t from, to;
  Vec3 first, last;
};

std::vector<KeySpan> spans_of(const PencilPath& path, const OrientationKeys& keys) {
  std::vector<KeySpan> out;
  for (auto at = keys.begin(), next = std::next(at); next != keys.end(); ++at, ++next)
    out.push_back({at->first, next->first, at->second, next->second});
  if (path.closed && keys.size() > 1) {
    const auto &last = *keys.rbegin(), &first = *keys.begin();
    out.push_back({last.first, first.first + path.size(), last.second, first.second});
  }
  for (const KeySpan& s : out)
    if (geom::angle_between(s.first, s.last) > kPi - 1e-6)
      refuse(s.to % path.size(), "opposite to the key at point " + std::to_string(s.from));
  return out;
}

void fill_linear(const KeySpan& span, std::vector<Vec3>& axes) {
  for (std::size_t i = span.from + 1; i < span.to; ++i) {
    const double u = static_cast<double>(i - span.from) / static_cast<double>(span.to - span.from);
    axes[i % axes.size()] = glm::normalize(span.first + u * (span.last - span.first));
  }
}

/// Fills the axes of a span in proportion to arc length; by index if its points coincide.
void fill_slerp(const KeySpan& span, const std::vector<double>& s, std::vector<Vec3>& axes) {
  const std::size_t n = axes.size();
  const auto station = [&](std::size_t i) { return i < n ? s[i] : s[n] + s[i - n]; };
  const double length = station(span.to) - station(span.from);
  const Motion turn({Vec3(0), span.first}, {Vec3(0), span.last});
  for (std::size_t i = span.from + 1; i < span.to; ++i) {
    const double u = length > 0 ? (station(i) - station(span.from)) / length
                                : static_cast<double>(i - span.from) / static_cast<double>(span.to - span.from);
    axes[i % n] = glm::normalize(turn.axis(u));
  }
}

void fill_smooth(const PencilPath& path, const OrientationKeys& keys, const std::vector<double>& s,
                 std::vector<Vec3>& axes) {
  std::vector<double> places;
  std::vector<Vec3> at;
  for (const auto& [k, axis] : keys) {
    if (!places.empty() && s[k] <= places.back())
      refuse(k, "at the same place as the key before it: no smooth curve of axes joins them");
    places.push_back(s[k]), at.push_back(axis);
  }
  if (path.closed && keys.size() > 1 && places.front() + s.back() <= places.back())
    refuse(keys.begin()->first, "at the same place as the last key: no smooth curve of axes joins them");
  const SmoothAxes curve(std::move(places), std::move(at), path.closed && keys.size() > 1 ? s.back() : 0);
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (!keys.contains(i)) axes[i] = curve.at(s[i]);
}

void apply(const AxisLimit& limit, std::vector<Vec3>& axes) {
  const Vec3 about = unit_axis(limit.about, "limit");
  if (!(limit.angle >= 0 && limit.angle < kPi))
    throw std::invalid_argument("limit: the angle must be at least 0 and below pi rad");
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const double angle = geom::angle_between(axes[k], about);
    if (angle <= limit.angle + 1e-12) continue;
    if (!limit.project)
      throw std::invalid_argument("limit, point " + std::to_string(k) + ": the axis is " + std::to_string(angle) +
                                  " rad from the limit's, allowed are " + std::to_string(limit.angle));
    axes[k] = project({about, limit.angle, true}, axes[k]);
  }
}

}  // namespace

Interpolation interpolation_named(std::string_view name) {
  for (const Interpolation rule : {Interpolation::Linear, Interpolation::Slerp, Interpolation::Smooth})
    if (name == name_of(rule)) return rule;
  throw std::invalid_argument("interpolation must be linear, slerp or smooth, not \"" + std::string(name) + "\"");
}

const char* name_of(Interpolation rule) {
  return kInterpolationNames[static_cast<int>(rule)];
}

Vec3 project(const AxisLimit& limit, const Vec3& axis) {
  if (geom::angle_between(axis, limit.about) <= limit.angle) return axis;
  // For an axis opposite to the cone, all paths onto it are equally short: cc_frame always picks the same.
  return glm::normalize(base::cos(limit.angle) * limit.about + base::sin(limit.angle) * cc_frame(axis, limit.about).x);
}

PencilPath oriented(const PencilPath& path, const OrientationKeys& keys, Interpolation rule,
                    const std::optional<AxisLimit>& limit) {
  if (keys.empty()) throw std::invalid_argument("keys: at least one is needed");
  const OrientationKeys good = checked(path, keys);
  std::vector<Vec3> axes(path.size(), good.begin()->second);
  for (std::size_t i = good.rbegin()->first; i < axes.size() && !(path.closed && good.size() > 1); ++i)
    axes[i] = good.rbegin()->second;
  for (const auto& [k, axis] : good) axes[k] = axis;
  const std::vector<KeySpan> spans = spans_of(path, good);
  const std::vector<double> s = stations(path);
  if (rule == Interpolation::Smooth) fill_smooth(path, good, s, axes);
  for (const KeySpan& span : spans) {
    if (rule == Interpolation::Linear) fill_linear(span, axes);
    if (rule == Interpolation::Slerp) fill_slerp(span, s, axes);
  }
  if (limit) apply(*limit, axes);
  return with_axes(path, std::move(axes), good, name_of(rule));
}

PencilPath with_axes(const PencilPath& path, std::vector<Vec3> axes, const OrientationKeys& keys,
                     std::string interpolation) {
  if (axes.size() != path.size())
    throw std::invalid_argument("axes must have " + std::to_string(path.size()) + " rows, one for each point");
  for (std::size_t k = 0; k < axes.size(); ++k) axes[k] = unit_axis(axes[k], "axes, row " + std::to_string(k));
  PencilPath out = path;
  out.axes = std::move(axes), out.keys = checked(path, keys), out.interpolation = std::move(interpolation);
  return out;
}

}  // namespace riffler::plan
