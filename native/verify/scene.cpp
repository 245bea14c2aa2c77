#include "verify/scene.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "nc/limits.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/mesh/orient.hpp"

namespace riffler::verify {

namespace {

VerifyArguments checked(VerifyArguments given) {
  const VerifyOptions& options = given.options;
  base::require_tolerance(options.tolerance);
  base::require_tolerance(options.gouge_tolerance, "gouge_tolerance");
  if (options.rest_tolerance) base::require_tolerance(*options.rest_tolerance, "rest_tolerance");
  base::require_between(options.rapid_feed, nc::kMinFeed, nc::kMaxFeed, "rapid_feed", "a positive feed", "mm/min");
  return given;
}

Box3 box_of_all(const VerifyArguments& given) {
  Box3 box = given.stock.frame().box;
  for (const Volume& v : given.fixtures) box.add(v.frame().box);
  return box;
}

/// How far a tool of unknown length must extend to reach beyond everything.
double beyond(const Box3& all) {
  return 2 * glm::length(all.size());
}

/// The part itself, or with its triangles reoriented.
std::shared_ptr<const Mesh> solid_of(std::shared_ptr<const Mesh> part) {
  try {
    validate(*part);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("part_mesh: ") + error.what());
  }
  mesh::Orientation found;
  std::optional<Mesh> turned = oriented(*part, found);
  return turned ? std::make_shared<const Mesh>(*std::move(turned)) : part;
}

std::unique_ptr<const Target> target_of(const Mesh& part, const dexel::Frame& frame, double tolerance,
                                        const Progress& progress) {
  try {
    return std::make_unique<Target>(part, frame, tolerance, progress);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("part_mesh: ") + error.what());
  }
}

}  // namespace

VerifyScene::VerifyScene(VerifyArguments arguments, const Progress& progress)
    : given_(checked(std::move(arguments))),
      top_(box_of_all(given_).upper.z),
      tools_(std::move(given_.tools), options().tolerance, beyond(box_of_all(given_)), stock().frame().pitch) {
  if (options().rest_tolerance && !part())
    throw std::invalid_argument("rest_tolerance: there is no part to compare with");
  if (part()) given_.part = solid_of(std::move(given_.part));
  if (part()) target_ = target_of(*part(), stock().frame(), options().gouge_tolerance, progress);
  add_jobs(stock(), -1);
  for (std::size_t k = 0; k < fixtures().size(); ++k) add_jobs(fixtures()[k], static_cast<std::int32_t>(k));
  if (target_) find_missing_material();
}

void VerifyScene::add_jobs(const Volume& volume, std::int32_t fixture) {
  for (const Slab& slab : slabs_of(volume)) {
    const dexel::Grid& grid = volume.grids()[slab.grid];
    const bool probed = &grid == &volume.reference();
    if (fixture >= 0 && !probed) continue;
    jobs_.push_back({fixture, slab, probed, material_box(grid, slab, tiles_of(grid, slab))});
  }
}

void VerifyScene::find_missing_material() {
  std::vector<std::vector<Event>> found(jobs_.size());
  base::parallel_for(jobs_.size(), 1, [&](std::size_t k, std::size_t) {
    const SlabJob& job = jobs_[k];
    if (job.fixture >= 0) return;
    const dexel::Grid& grid = grid_of(job);
    find_missing(*target_, grid, job.slab, tiles_of(grid, job.slab), found[k]);
  });
  for (const std::vector<Event>& events : found) missing_.insert(missing_.end(), events.begin(), events.end());
  // The target's grids end at the stock's box.
  const Box3 &out = target_->bounds(), &in = stock().frame().box;
  for (int k = 0; k < 3; ++k)
    for (const double over : {in.lower[k] - out.lower[k], out.upper[k] - in.upper[k]})
      if (over > options().gouge_tolerance) {
        Vec3 point = (out.lower + out.upper) / 2.0;
        point[k] = over == in.lower[k] - out.lower[k] ? out.lower[k] : out.upper[k];
        missing_.push_back({Kind::Gouge, Member::Cutter, -1, 0, over, over, point});
      }
}

std::vector<SlabState> VerifyScene::fresh() const {
  std::vector<SlabState> slabs(jobs_.size());
  for (std::size_t k = 0; k < jobs_.size(); ++k) slabs[k].tiles = tiles_of(grid_of(jobs_[k]), jobs_[k].slab);
  return slabs;
}

SlabTiles VerifyScene::part_in(const SlabJob& job) const {
  return target_ && job.fixture < 0 ? target_->tiles(job.slab) : SlabTiles();
}

const dexel::Grid& VerifyScene::grid_of(const SlabJob& job) const {
  const Volume& volume = job.fixture < 0 ? stock() : fixtures()[static_cast<std::size_t>(job.fixture)];
  return volume.grids()[job.slab.grid];
}

void VerifyScene::simulate(const Moves& moves, std::vector<SlabState>& slabs, bool keep, VerifyStats& stats,
                           const Progress& progress) const {
  std::vector<VerifyStats> counts(jobs_.size());
  const std::int64_t row = moves.row(0);
  base::parallel_for(
      jobs_.size(), 1,
      [&](std::size_t k, std::size_t) {
        const SlabJob& job = jobs_[k];
        SlabState& slab = slabs[k];
        const auto first = static_cast<std::size_t>(std::max<std::int64_t>(0, slab.done + 1 - row));
        if (first >= moves.size()) return;
        slab.done = moves.row(moves.size() - 1);
        const PartSurface* surface = target_ && job.fixture < 0 ? &target_->surface() : nullptr;
        const SlabPlace place{grid_of(job),        job.slab, job.fixture, job.probed,
                              options().tolerance, surface,  part_in(job)};
        SlabSaved saved;
        if (keep) saved = [&](std::int64_t at, const SlabTiles& tiles) { slab.save(at, tiles); };
        verify::simulate(place, moves, first, slab.tiles, slab.report, counts[k], saved);
      },
      progress);
  for (const VerifyStats& c : counts) stats += c;
}

}  // namespace riffler::verify
