#include "bench/contact_run.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <span>
#include <sstream>
#include <stdexcept>

#include "base/own_thread.hpp"
#include "bench/contact_parts.hpp"
#include "bench/process.hpp"
#include "reference/surface_distance.hpp"
#include "reference/surface_entry.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::bench {

namespace {

constexpr double kBudget = 200e-6, kDoubt = 0.05;  // s and mm, for a thousand queries a second
constexpr double kAway = 1000;                     // mm
constexpr int kBlock = 100;                        // poses for which one query runs before the next query's turn

/// Writes an object's members in their order.
class Json {
 public:
  Json& text(const char* name, const std::string& value) {
    member(name) << '"' << value << '"';
    return *this;
  }
  Json& number(const char* name, double value) {
    member(name) << value;
    return *this;
  }
  Json& numbers(const char* name, std::span<const double> values, double factor = 1) {
    std::ostream& out = member(name) << '[';
    for (std::size_t k = 0; k < values.size(); ++k) out << (k > 0 ? "," : "") << factor * values[k];
    out << ']';
    return *this;
  }
  Json& objects(const char* name, const std::vector<std::string>& values) {
    std::ostream& out = member(name) << '[';
    for (std::size_t k = 0; k < values.size(); ++k) out << (k > 0 ? "," : "") << values[k];
    out << ']';
    return *this;
  }
  std::string object() const { return '{' + out_.str() + '}'; }

 private:
  std::ostream& member(const char* name) {
    if (out_.tellp() > 0) out_ << ", ";
    return out_ << std::setprecision(9) << '"' << name << "\": ";
  }
  std::ostringstream out_;
};

struct Scene {
  Mesh part;
  Tool tool;
  std::vector<Pose> poses;

  explicit Scene(const ContactOptions& o) : tool(named(o.tool)) {
    if (o.part.empty()) {
      part = valleys(o.squares), poses = contact_poses(part, o.squares, o.poses, o.seed);
    } else {
      ContactPart made = contact_part(o.part, tool, o.poses, o.seed);
      part = std::move(made.mesh), poses = std::move(made.poses);
    }
  }

  static Tool named(const std::string& name) {
    for (const ContactTool& t : contact_tools())
      if (t.name == name) return t.tool;
    throw std::invalid_argument("tool: unknown tool \"" + name + '"');
  }
};

std::vector<Ask> ours(const collide::Collider& collider, const collide::Assembly& assembly, double build_s) {
  const auto query = [&](const Pose& pose) { return collider.query(assembly, pose).depth; };
  const auto clearance = [&](const Pose& pose) { return collider.clearance(assembly, pose); };
  return {{"Riffler", "depth, force and torque", query, build_s}, {"Riffler", "signed distance", clearance, build_s}};
}

struct Timed {
  std::vector<double> seconds, answers;
};

std::vector<Timed> timed(const std::vector<Ask>& asks, const std::vector<Pose>& poses, int repeats) {
  std::vector<Timed> out(asks.size());
  std::vector<std::vector<std::vector<double>>> all(asks.size(), std::vector<std::vector<double>>(poses.size()));
  for (std::size_t from = 0; from < poses.size(); from += kBlock)
    for (int r = 0; r < repeats; ++r)
      for (std::size_t a = 0; a < asks.size(); ++a) {
        const std::size_t to = std::min({poses.size(), from + kBlock, static_cast<std::size_t>(asks[a].most)});
        for (std::size_t k = from; k < to; ++k) {
          const double start = base::thread_seconds(), answer = asks[a].call(poses[k]);
          all[a][k].push_back(base::thread_seconds() - start);
          if (r == 0) out[a].answers.push_back(answer);
        }
      }
  for (std::size_t a = 0; a < asks.size(); ++a)
    for (const std::vector<double>& times : all[a])
      if (!times.empty()) out[a].seconds.push_back(median(times));
  return out;
}

/// Processor time of a query with the tool `kAway` above each pose, where nothing is in reach: the least mean of the
/// repetitions.
double away_seconds(const collide::Collider& collider, const collide::Assembly& assembly, std::vector<Pose> poses,
                    int repeats) {
  for (Pose& pose : poses) pose.tip.z += kAway;
  double least = 1e300;
  for (int r = 0; r < repeats; ++r) {
    double deepest = 0;
    const double start = base::thread_seconds();
    for (const Pose& pose : poses) deepest = std::max(deepest, collider.query(assembly, pose).depth);
    least = std::min(least, (base::thread_seconds() - start) / static_cast<double>(poses.size()));
    if (deepest > 0) throw std::logic_error("a tool that is out of reach touches");
  }
  return least;
}

std::vector<reference::Corners> corners_of(const Mesh& mesh) {
  std::vector<reference::Corners> out;
  for (const Vec3i& t : mesh.triangles) out.push_back({mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]});
  return out;
}

}  // namespace

std::string contact_times(const ContactOptions& options, const std::vector<Rival>& rivals) {
  const Scene scene(options);
  const Mesh tool_mesh = turned(scene.tool, 36);
  const double start = base::thread_seconds();
  const collide::Collider collider(scene.part);
  const double build_s = base::thread_seconds() - start;
  const collide::Assembly assembly(scene.tool);
  std::vector<Ask> asks = ours(collider, assembly, build_s);
  for (const Rival& rival : rivals)
    for (Ask& ask : rival({scene.part, scene.tool, tool_mesh}))
      // FCL's signed distance aborts at an assertion for triangles as long as those of these parts.
      if (options.part.empty() || ask.what != "signed distance") asks.push_back(std::move(ask));
  const std::vector<Timed> results = timed(asks, scene.poses, options.repeats);

  double colliding = 0, holder = 0, doubtful = 0;
  for (const Pose& pose : scene.poses)
    if (const collide::Collider::Nearest at = collider.nearest(assembly, pose); at.distance < 0)
      colliding += 1, holder += at.touch == collide::Touch::Holder;
  for (const Pose& pose : scene.poses) {
    // A budget is real time: where another process interrupts a query, its answer says nothing of the query.
    std::vector<double> bounds;
    for (int r = 0; r < options.repeats; ++r)
      bounds.push_back(collider.query(assembly, pose, kBudget).missed_depth_bound);
    doubtful += median(bounds) > kDoubt;
  }
  std::vector<std::string> rows;
  for (std::size_t a = 0; a < asks.size(); ++a)
    rows.push_back(Json()
                       .text("engine", asks[a].engine)
                       .text("what", asks[a].what)
                       .number("build_s", asks[a].build_s)
                       .numbers("us", results[a].seconds, 1e6)
                       .numbers("answers", results[a].answers)
                       .object());
  return Json()
      .number("triangles", static_cast<double>(scene.part.triangles.size()))
      .number("tool_triangles", static_cast<double>(tool_mesh.triangles.size()))
      .number("colliding", colliding / options.poses)
      .number("holder", holder / options.poses)
      .number("in_doubt", doubtful / options.poses)
      .number("away_us", 1e6 * away_seconds(collider, assembly, scene.poses, options.repeats))
      .objects("asked", rows)
      .object();
}

std::string contact_budgets(const ContactOptions& options, const std::vector<double>& budgets) {
  const Scene scene(options);
  const collide::Collider collider(scene.part);
  const collide::Assembly assembly(scene.tool);
  std::vector<double> exact;
  for (const Pose& pose : scene.poses) exact.push_back(std::max(0.0, -collider.clearance(assembly, pose)));
  std::vector<std::string> rows;
  for (const double budget : budgets) {
    std::vector<double> seconds, missed, bounds, checked;
    for (std::size_t k = 0; k < scene.poses.size(); ++k) {
      const double start = base::thread_seconds();
      const collide::Contact contact = collider.query(assembly, scene.poses[k], budget);
      seconds.push_back(base::thread_seconds() - start);
      missed.push_back(exact[k] - contact.depth);
      bounds.push_back(contact.missed_depth_bound), checked.push_back(contact.checked);
    }
    rows.push_back(Json()
                       .number("budget_us", 1e6 * budget)
                       .numbers("us", seconds, 1e6)
                       .numbers("missed_mm", missed)
                       .numbers("bound_mm", bounds)
                       .numbers("checked", checked)
                       .object());
  }
  return Json().numbers("depth_mm", exact).objects("budgets", rows).object();
}

std::string contact_errors(const ContactOptions& options, std::size_t points, int brackets, double gap) {
  const Scene scene(options);
  const collide::Collider collider(scene.part);
  const collide::Assembly assembly(scene.tool);
  const reference::AssemblyDistance tool(scene.tool);
  const std::vector<reference::Corners> corners = corners_of(scene.part);
  const reference::SpreadPoints spread = reference::spread_points(corners, points);
  std::vector<double> ours, queried, sampled, lower, upper;
  for (std::size_t k = 0; k < scene.poses.size(); ++k) {
    const Pose& pose = scene.poses[k];
    ours.push_back(collider.clearance(assembly, pose));
    queried.push_back(collider.query(assembly, pose).depth);
    sampled.push_back(reference::least_over(spread.points, tool, pose));
    if (static_cast<int>(k) >= brackets) continue;
    const reference::SurfaceBracket bracket = reference::least_distance(corners, tool, pose, gap);
    lower.push_back(bracket.lower), upper.push_back(bracket.upper);
  }
  return Json()
      .number("points", static_cast<double>(spread.points.size()))
      .number("spacing_mm", spread.spacing)
      .numbers("clearance_mm", ours)
      .numbers("depth_mm", queried)
      .numbers("sampled_mm", sampled)
      .numbers("lower_mm", lower)
      .numbers("upper_mm", upper)
      .object();
}

std::string contact_slide(int steps) {
  constexpr double kDeep = 0.2, kRadius = 3, kFine = 0.02;
  // A plane, x < 0, and the wall below its edge.
  Mesh part;
  part.vertices = {{-20, -20, 0}, {0, -20, 0}, {0, 20, 0}, {-20, 20, 0}, {0, -20, -20}, {0, 20, -20}};
  part.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  const Tool ball = cutters::ball(2 * kRadius, 30);
  const collide::Collider collider(part);
  const collide::Assembly assembly(ball);
  const reference::AssemblyDistance tool(ball);
  std::vector<double> x, fx, fz, depth, rx, rz;
  for (int k = 0; k <= steps; ++k) {
    const Pose pose{{-3 + 6.0 * k / steps, 0.1, -kDeep}, {0, 0, 1}};
    const collide::Contact contact = collider.query(assembly, pose);
    x.push_back(pose.tip.x), depth.push_back(contact.depth);
    fx.push_back(contact.force.x), fz.push_back(contact.force.z);
    // Midpoint rule over plane and wall within reach of the ball.
    double across = 0, up = 0;
    for (double v = -kRadius; v < kRadius; v += kFine)
      for (double u = 0; u < 2 * kRadius; u += kFine) {
        up -= std::min(0.0, tool({-u - kFine / 2, v + 0.1 + kFine / 2, 0}, pose));
        across -= std::min(0.0, tool({0, v + 0.1 + kFine / 2, -u - kFine / 2}, pose));
      }
    rx.push_back(across * kFine * kFine), rz.push_back(up * kFine * kFine);
  }
  return Json()
      .numbers("x_mm", x)
      .numbers("depth_mm", depth)
      .numbers("force_x_N", fx)
      .numbers("force_z_N", fz)
      .numbers("reference_x_N", rx)
      .numbers("reference_z_N", rz)
      .object();
}

std::vector<std::array<double, 2>> contact_entries(const Mesh& mesh, const Tool& tool, std::span<const Pose> poses,
                                                   double gap) {
  std::vector<std::array<double, 2>> out;
  out.reserve(poses.size());
  for (const reference::Entry& e : reference::entries(corners_of(mesh), reference::AssemblyDistance(tool), poses, gap))
    out.push_back({e.attained, e.bound});
  return out;
}

}  // namespace riffler::bench
