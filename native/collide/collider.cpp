#include "riffler/collide/collider.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

#include "collide/drift.hpp"
#include "collide/fixture.hpp"
#include "collide/force.hpp"
#include "collide/nearest_search.hpp"
#include "collide/swept_search.hpp"
#include "collide/winding.hpp"
#include "nurbs/exact_triangles.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/mesh/decimate/decimate.hpp"
#include "riffler/mesh/orient.hpp"

namespace riffler::collide {

namespace {

constexpr double kPieces = 32;  // length of the pieces of large triangles, in units of the chosen point spacing
constexpr double kBoxes = 1.5;  // side of a fixture's boxes, in units of the part's point spacing
// As shares of an exact part's size: largest distance from it of the tree's triangles, and of those that check motions.
constexpr double kChord = 2e-4, kFineChord = 2e-5;
constexpr double kCellChord = 0.05;  // largest distance of a triangle from the exact part, relative to its cell's size
constexpr double kLongestCell = 0.05;  // of the part's size
constexpr double kNone = -std::numeric_limits<double>::infinity();

void check(const Collider::Settings& s, std::size_t fixtures) {
  const auto check_one = [](double x, const char* name) {
    if (!std::isfinite(x) || x < 0)
      throw std::invalid_argument(std::string(name) + " must not be negative or not finite");
  };
  check_one(s.spacing, "spacing"), check_one(s.coarse, "coarse"), check_one(s.stiffness, "stiffness");
  check_one(s.holder_stiffness, "holder_stiffness"), check_one(s.fixture_stiffness, "fixture_stiffness");
  if (!s.stiffness_of_each.empty() && s.stiffness_of_each.size() != fixtures)
    throw std::invalid_argument("fixture_stiffness must be one number, or one for each fixture: there are " +
                                std::to_string(s.stiffness_of_each.size()) + " for " + std::to_string(fixtures));
  for (std::size_t i = 0; i < s.stiffness_of_each.size(); ++i)
    check_one(s.stiffness_of_each[i], ("fixture_stiffness, number " + std::to_string(i) + ",").c_str());
}

Mesh mesh_of(const Volume& volume, std::size_t index) {
  try {
    // Merge coplanar triangles: otherwise very many are equally near to a flank that lies along a face. A clearance
    // below the mesh error of a carved volume cannot be proven, and trying takes tens of seconds.
    return decimate(marching::to_mesh(volume), {{}, 1e-2 * volume.frame().pitch});
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument("fixtures, volume " + std::to_string(index) + ": " + e.what());
  }
}

nurbs::Fineness fineness(const nurbs::Surface& surface, double chord) {
  const double size = glm::length(surface.bounds().size());
  return {chord * size, kLongestCell * size, kCellChord};
}

}  // namespace

struct Collider::Data {
  std::optional<nurbs::ExactTriangles> exact;
  Surface part;
  SamplePoints points;
  std::optional<Surface> pieces;  // of the part, where it has large triangles
  double longest = 0;             // mm: of these pieces
  std::vector<Fixture> fixtures;
  std::vector<double> stiffness;         // one per fixture
  std::vector<const Surface*> surfaces;  // the part's is first
  std::vector<const Surface*> searched;  // the same, the part in pieces
  Settings settings;
  Box3 box;                      // box around all surfaces
  mutable std::once_flag asked;  // winding is computed on the first query for a side of the part
  mutable std::optional<WindingNumber> winding;
  std::optional<nurbs::Surface> whole;  // the exact part, for the checks of motions
  mutable std::once_flag moved;
  mutable std::optional<nurbs::ExactTriangles> fine;
  mutable std::optional<Surface> chords;  // of the exact part, short ones

  Data(const nurbs::Surface& surface, const Settings& s)
      : exact(nurbs::exact_triangles(surface.core(), fineness(surface, kChord))),
        part(*exact),
        points(part, s.spacing),
        settings(s),
        box(surface.bounds()),
        whole(surface) {
    longest = kPieces * chosen_spacing(part, 0);
  }
  Data(const Mesh& mesh, const Settings& s)
      : part(mesh), points(part, s.spacing), settings(s), box(mesh::bounds(mesh)) {
    longest = kPieces * chosen_spacing(part, 0);
    if (is_longer(mesh, longest)) pieces.emplace(divided(mesh, longest));
  }

  void add(const std::vector<Volume>& volumes);
  std::vector<const Surface*> for_motions() const;
  NearestSearch::Found search(const Assembly& assembly, const ToolFrame& frame, bool all, Deadline deadline,
                              Counts& counts, double enough = kNone, double loose = 0, double below = -kNone) const;
};

Collider::Collider(const Mesh& part, std::vector<Volume> fixtures, const Settings& settings) {
  check(settings, fixtures.size());
  validate(part);
  if (part.empty()) throw std::invalid_argument("part: a mesh without triangles");
  std::optional<Mesh> storage;
  data_ = std::make_unique<Data>(as_solid(part, storage, mesh::Hollow::Kept), settings);
  data_->add(fixtures);
}

Collider::Collider(const nurbs::Surface& part, std::vector<Volume> fixtures, const Settings& settings) {
  check(settings, fixtures.size());
  data_ = std::make_unique<Data>(part, settings);
  data_->add(fixtures);
}

void Collider::Data::add(const std::vector<Volume>& volumes) {
  fixtures.reserve(volumes.size());
  for (std::size_t i = 0; i < volumes.size(); ++i)
    if (const Mesh m = mesh_of(volumes[i], i); !m.empty()) {
      box.add(mesh::bounds(m));
      fixtures.emplace_back(volumes[i], m, kBoxes * points.spacing());
      stiffness.push_back(settings.stiffness_of_each.empty() ? settings.fixture_stiffness
                                                             : settings.stiffness_of_each[i]);
    }
  surfaces.push_back(&part);
  for (const Fixture& f : fixtures) surfaces.push_back(&f.surface());
  searched = surfaces;
  if (pieces) searched.front() = &*pieces;
}

Collider::~Collider() = default;
Collider::Collider(Collider&&) noexcept = default;
Collider& Collider::operator=(Collider&&) noexcept = default;

/// Smallest distance from the part, or from part and fixtures.
NearestSearch::Found Collider::Data::search(const Assembly& assembly, const ToolFrame& frame, bool all,
                                            Deadline deadline, Counts& counts, double enough, double loose,
                                            double below) const {
  const std::span<const Surface* const> some(searched.data(), all ? searched.size() : 1);
  NearestSearch search(assembly, frame);
  search.enough(enough), search.loose(loose), search.below(below);
  NearestSearch::Found found = search(some, deadline, counts);
  if (!all) return found;
  for (std::size_t i = 0; i < fixtures.size(); ++i) {
    if (!fixtures[i].near(assembly, frame, 0)) continue;
    for (const Vec2& p : assembly.deepest()) {
      const double depth = assembly.outline().nearest(p.x, p.y).distance;
      const Vec3 place(p.x, 0, p.y);
      if (depth >= found.least.distance || !fixtures[i].holds(frame.to_part(place))) continue;
      found.least = {depth, place, assembly.part_at(p.y)};
      found.surface = i + 1, found.low = std::min(found.low, depth);
    }
  }
  return found;
}

double Collider::clearance(const Assembly& assembly, const Pose& pose) const {
  Counts counts;
  return clearance(assembly, pose, counts);
}

double Collider::clearance(const Assembly& assembly, const Pose& pose, Counts& counts) const {
  return data_->search(assembly, ToolFrame(pose), false, {}, counts).least.distance;
}

Collider::Nearest Collider::nearest(const Assembly& assembly, const Pose& pose, double loose) const {
  const ToolFrame frame(pose);
  Counts counts;
  const NearestSearch::Found found = data_->search(assembly, frame, true, {}, counts, kNone, loose);
  return {found.least.distance, frame.to_part(found.least.point),
          found.surface > 0 ? Touch::Fixture : static_cast<Touch>(found.least.part)};
}

bool Collider::keeps(const Assembly& assembly, const Pose& pose, double wanted) const {
  Counts counts;
  return data_->search(assembly, ToolFrame(pose), true, {}, counts, wanted).least.distance >= wanted;
}

Contact Collider::query(const Assembly& assembly, const Pose& pose, std::optional<double> budget) const {
  Counts counts;
  return query(assembly, pose, budget, counts);
}

Contact Collider::query(const Assembly& assembly, const Pose& pose, std::optional<double> budget,
                        Counts& counts) const {
  Contact out;
  query(assembly, pose, budget, counts, out, 0);
  return out;
}

void Collider::query(const Assembly& assembly, const Pose& pose, std::optional<double> budget, Contact& contact,
                     double loose) const {
  Counts counts;
  query(assembly, pose, budget, counts, contact, loose);
}

void Collider::query(const Assembly& assembly, const Pose& pose, std::optional<double> budget, Counts& counts,
                     Contact& out, double loose) const {
  // Most of a budget goes to the depth. A force sum that runs out of time uses coarser points.
  const auto until = [start = Deadline::Clock::now(), &budget](double share) {
    return budget ? Deadline(start + std::chrono::duration_cast<Deadline::Clock::duration>(
                                         std::chrono::duration<double>(share * *budget)))
                  : Deadline();
  };
  const ToolFrame frame(pose);
  const NearestSearch::Found found = data_->search(assembly, frame, true, until(0.6), counts, kNone, loose, 0);
  out.force = out.torque = Vec3(0), out.stiffness = {};
  out.points.clear(), out.touches.clear();
  out.depth = std::max(0.0, -found.least.distance), out.checked = found.checked;
  // No point can be deeper inside the tool than its largest radius. The search's own slack counts as missed depth.
  const double most = std::min(-found.low + found.slack, assembly.max_radius());
  out.missed_depth_bound = std::max(0.0, most - out.depth);
  if (!(found.least.distance < 0)) return;
  out.points.push_back(frame.to_part(found.least.point));
  out.touches.push_back(found.surface > 0 ? Touch::Fixture : static_cast<Touch>(assembly.part_at(found.least.point.z)));
  const Settings& s = data_->settings;
  Deadline deadline = until(1);
  const Stiffness stiffness{s.stiffness, s.holder_stiffness};
  add_force(assembly, frame, data_->points, stiffness, s.coarse, s.spacing == 0 && !data_->exact, deadline, out,
            counts);
  for (std::size_t i = 0; i < data_->fixtures.size(); ++i)
    if (const Fixture& f = data_->fixtures[i]; f.near(assembly, frame, 0))
      f.add_force(assembly, frame, data_->stiffness[i], s.fixture_push == FixturePush::Centre, deadline, out, counts);
}

/// The surfaces, with short chords of an exact part.
std::vector<const Surface*> Collider::Data::for_motions() const {
  std::call_once(moved, [&] {
    fine.emplace(nurbs::exact_triangles(whole->core(), fineness(*whole, kFineChord)));
    chords.emplace(*fine);
  });
  std::vector<const Surface*> out = surfaces;
  out.front() = &*chords;
  return out;
}

Swept Collider::sweep(const Assembly& assembly, const Motion& motion, double wanted, std::size_t most) const {
  if (data_->exact) {  // the part is at most a chord nearer than the chords
    const std::vector<const Surface*> some = data_->for_motions();
    const double chord = some.front()->max_chord();
    Swept swept = SweptSearch(assembly, motion, wanted + chord, most)(some);
    swept.clearance -= chord, swept.bound -= chord;
    return swept;
  }
  // From a piece far ahead of the tool a plane faces along the motion: for long motions whole triangles are better.
  const Drift drift(motion, 1, assembly.reach());
  const bool is_long = drift.most(assembly.reach()) > data_->longest;
  return SweptSearch(assembly, motion, wanted, most)(is_long ? data_->surfaces : data_->searched);
}

bool Collider::inside_part(const Vec3& p) const {
  std::call_once(data_->asked, [&] { data_->winding.emplace(data_->part); });
  return (*data_->winding)(p) > 0.5;
}

const Box3& Collider::bounds() const {
  return data_->box;
}

double Collider::spacing() const {
  return data_->points.spacing();
}
std::size_t Collider::triangles() const {
  return data_->part.size();
}
std::size_t Collider::points() const {
  return data_->points.size();
}
std::size_t Collider::fixtures() const {
  return data_->fixtures.size();
}

}  // namespace riffler::collide
