#include "riffler/dexel/from_mesh/from_mesh.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/functions.hpp"
#include "dexel/from_mesh/crossing_lanes.hpp"
#include "dexel/from_mesh/crossings.hpp"
#include "dexel/from_mesh/flatness.hpp"
#include "dexel/from_mesh/mesh_findings.hpp"
#include "dexel/from_mesh/openings.hpp"
#include "dexel/from_mesh/solid_mesh.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/mesh/measure.hpp"

namespace riffler::dexel {

namespace {

/// Spans and gaps shorter than this vanish, cells.
constexpr double kThinnest = 1e-9;
/// Same, next to an opening. |w| = ½ is located to about 1e-6 in w, which in an opening of a thousand cells may
/// correspond to this distance.
constexpr double kThinnestOpening = 1e-2;

/// Fraction of the time spent on counting a mesh's defects.
constexpr double kCounted = 0.1;

/// Sources of ends at the box's side, and of repaired passages.
constexpr std::uint32_t kBox = 0xffffffffU, kRepaired = 0xfffffffeU;

/// An end of a column's span under construction: its position, and the source of its normal. If not `outward`, the
/// normal is reversed.
struct End {
  double z;
  std::uint32_t source;
  bool outward;
};

double most(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Fills one grid from the crossings of its columns.
class Filler {
 public:
  Filler(const Mesh& mesh, const std::vector<std::vector<int>>& loops, Grid& grid, const Progress& progress,
         MeshFindings* findings);

  /// Number of triangles in all bands, which is the number of triangles tested.
  std::size_t triangles_tested() const { return bands_.size(); }
  /// Whether a column has material where the winding number is negative.
  bool negative() const { return negative_.load(std::memory_order_relaxed); }
  void run(const Progress& progress);

 private:
  struct Scratch {
    BandCrossings unsorted;
    std::vector<Crossing> sorted, repaired;
    std::vector<std::uint32_t> begin;
  };

  int rows_per_band() const;
  void tile_row(int tile_u, Scratch& scratch, std::vector<TileBuilder>& builders, ColumnTally& tally) const;
  void add_passages(int first, int last, BandCrossings& out) const;
  void fill(std::span<const Crossing> crossings, TileBuilder& builder) const;
  bool repair(int row, int column, std::span<const Crossing> crossings, std::vector<Crossing>& out) const;
  void look(std::span<const Crossing> crossings, double area, ColumnTally& tally) const;
  void emit(End near, End far, TileBuilder& builder) const;
  PackedNormal normal(const End& end) const;
  double thinnest(const End& a, const End& b) const {
    return grid_.pitch() * (((a.source | b.source) & kOpening) != 0 ? kThinnestOpening : kThinnest);
  }

  const Mesh& mesh_;
  const std::vector<std::vector<int>>& loops_;
  Box3 box_;
  Grid& grid_;
  Projection projection_;
  std::vector<Passage> passages_;
  Bands bands_;
  MeshFindings* findings_;
  mutable std::atomic<bool> negative_{false};
};

Filler::Filler(const Mesh& mesh, const std::vector<std::vector<int>>& loops, Grid& grid, const Progress& progress,
               MeshFindings* findings)
    : mesh_(mesh),
      loops_(loops),
      box_(loops.empty() ? Box3{} : bounds(mesh)),
      grid_(grid),
      projection_(mesh, grid),
      passages_(loops.empty() ? std::vector<Passage>{} : find_passages(mesh, loops, projection_, grid, progress)),
      bands_(mesh, projection_, rows_per_band()),
      findings_(findings) {}

/// A divisor of the tile's side for which a band's crossings stay in the cache.
int Filler::rows_per_band() const {
  int rows = kTileSide;
  while (rows > 1 && rows * grid_.nv() > 16384) rows /= 2;
  return rows;
}

void Filler::run(const Progress& progress) {
  std::vector<ColumnTally> tallies(static_cast<std::size_t>(grid_.tiles_u()));
  base::parallel_for(
      static_cast<std::size_t>(grid_.tiles_u()), 1,
      [&](std::size_t begin, std::size_t end) {
        Scratch scratch;
        std::vector<TileBuilder> builders(static_cast<std::size_t>(grid_.tiles_v()), TileBuilder(grid_.has_normals()));
        for (std::size_t k = begin; k < end; ++k) tile_row(static_cast<int>(k), scratch, builders, tallies[k]);
      },
      progress);
  if (findings_)
    for (const ColumnTally& tally : tallies) findings_->tally += tally;
}

void Filler::tile_row(int tile_u, Scratch& scratch, std::vector<TileBuilder>& builders, ColumnTally& tally) const {
  const int first_row = tile_u * kTileSide, end_row = std::min(grid_.nu(), first_row + kTileSide), nv = grid_.nv();
  for (int first = first_row; first < end_row; first += bands_.rows()) {
    const int last = std::min(end_row, first + bands_.rows());
    scratch.unsorted.clear();
    find_crossings(mesh_.triangles, bands_.band(first / bands_.rows()), projection_, first, last, scratch.unsorted);
    add_passages(first, last, scratch.unsorted);
    const std::size_t columns = static_cast<std::size_t>(last - first) * static_cast<std::size_t>(nv);
    sort_by_column(scratch.unsorted, columns, scratch.sorted, scratch.begin);

    std::size_t column = 0;
    for (int row = first; row < last; ++row) {
      for (int j = 0; j < nv; ++j, ++column) {
        TileBuilder& builder = builders[static_cast<std::size_t>(j / kTileSide)];
        std::span<const Crossing> crossings{scratch.sorted.data() + scratch.begin[column],
                                            scratch.sorted.data() + scratch.begin[column + 1]};
        if (!loops_.empty() && repair(row, j, crossings, scratch.repaired)) crossings = scratch.repaired;
        if (!crossings.empty()) fill(crossings, builder);
        if (findings_ && !crossings.empty()) look(crossings, grid_.area(row, j), tally);
        builder.next_ray();
      }
      // rays outside the grid
      for (int j = nv; j % kTileSide != 0; ++j) builders.back().next_ray();
    }
  }
  for (int k = 0; k < grid_.tiles_v(); ++k) {
    TileBuilder& builder = builders[static_cast<std::size_t>(k)];
    std::shared_ptr<Tile> tile = builder.finish();
    if (!tile->spans.empty()) grid_.set_tile(grid_.tile_index(tile_u, k), std::move(tile));
  }
}

void Filler::add_passages(int first, int last, BandCrossings& out) const {
  const auto by_row = [](const Passage& p, int row) { return p.row < row; };
  const auto begin = std::lower_bound(passages_.begin(), passages_.end(), first, by_row);
  const auto end = std::lower_bound(begin, passages_.end(), last, by_row);
  for (auto p = begin; p != end; ++p) {
    const auto source = kOpening | static_cast<std::uint32_t>(p - passages_.begin());
    const auto column = static_cast<std::uint32_t>(p->row - first) * static_cast<std::uint32_t>(grid_.nv());
    out.add({p->z, source, p->sign}, column + static_cast<std::uint32_t>(p->column));
  }
}

/// Adds spans where the running sum of the signs is not zero.
void Filler::fill(std::span<const Crossing> crossings, TileBuilder& builder) const {
  End near{}, far{};  // the last span, not yet emitted: a gap after it may vanish
  bool waiting = false;
  End from{};  // where the current span began
  int sum = 0;
  for (const Crossing& c : crossings) {
    const int before = sum;
    sum += c.sign;
    if (before == 0) {
      from = {c.z, c.source, sum > 0};
      if (!waiting) continue;
      if (from.z - far.z <= thinnest(from, far))
        from = near;
      else
        emit(near, far, builder);
      waiting = false;
    } else if (sum == 0) {
      const End to{c.z, c.source, before > 0};
      if (!(to.z - from.z > thinnest(from, to))) continue;
      if (before < 0) negative_.store(true, std::memory_order_relaxed);
      near = from, far = to, waiting = true;
    }
  }
  if (waiting) emit(near, far, builder);
}

/// Records what a column shows about the mesh.
void Filler::look(std::span<const Crossing> crossings, double area, ColumnTally& tally) const {
  const double lower = grid_.box().lower.z, upper = grid_.box().upper.z;
  const double before = tally.inside;
  bool doubtful = false;
  int sum = 0;
  for (std::size_t k = 0; k < crossings.size(); ++k) {
    const Crossing& c = crossings[k];
    const bool open = (c.source & kOpening) != 0;
    const int last = std::exchange(sum, sum + c.sign);
    if (last == 0 || sum == 0) doubtful |= open && c.z > lower && c.z < upper;
    // Negative on one side and zero on the other: the triangle faces into the material.
    if (!open && std::max(last, sum) == 0)
      std::atomic_ref(findings_->flipped[c.source]).store(1, std::memory_order_relaxed);
    if (sum == 0 || k + 1 == crossings.size()) continue;
    const double length = std::min(upper, crossings[k + 1].z) - std::max(lower, c.z);
    if (!(length > grid_.pitch() * kThinnestOpening)) continue;
    tally.inside += length, tally.enclosed += sum * length * area;
    if (std::abs(sum) > 1) tally.overlap += length;
    if (sum < 0) tally.inside_out += length;
  }
  const bool some = tally.inside > before;
  tally.rays += some, tally.doubtful += some && doubtful;
}

/// Clips a span to the box and appends it.
void Filler::emit(End near, End far, TileBuilder& builder) const {
  const double lower = grid_.box().lower.z, upper = grid_.box().upper.z;
  if (near.z < lower) near = {lower, kBox, false};
  if (far.z > upper) far = {upper, kBox, true};
  if (!(far.z - near.z > kThinnest * grid_.pitch())) return;
  SpanNormals normals;
  if (grid_.has_normals()) normals = {normal(near), normal(far)};
  builder.add({near.z, far.z}, normals);
}

PackedNormal Filler::normal(const End& end) const {
  Vec3 n(0, 0, 1);  // for the box, and for repaired passages
  if ((end.source & kOpening) == 0) {
    const Vec3i& t = mesh_.triangles[end.source];
    const Vec3 &a = mesh_.vertices[t.x], &b = mesh_.vertices[t.y], &c = mesh_.vertices[t.z];
    n = glm::cross(b - a, c - a);
    if (!(glm::dot(n, n) > 0)) n = to_world(grid_.axis(), Vec3(0, 0, 1));
  } else if (end.source < kRepaired) {
    n = passages_[end.source & ~kOpening].normal.unpack();
  } else {
    n = to_world(grid_.axis(), n);
  }
  const double length = glm::length(n);
  if (!(length > 0)) return PackedNormal::pack(to_world(grid_.axis(), Vec3(0, 0, end.outward ? 1 : -1)));
  return PackedNormal::pack((end.outward ? 1 : -1) / length * n);
}

/// Crossings and passages of a column sum to zero unless rounding near a boundary edge lost or doubled a passage. In
/// that case, finds the passages again with the winding number itself, sampled between all places where something was
/// found.
bool Filler::repair(int row, int column, std::span<const Crossing> crossings, std::vector<Crossing>& out) const {
  int sum = 0;
  for (const Crossing& c : crossings) sum += c.sign;
  if (sum == 0) return false;
  const double h = grid_.pitch();
  const auto rounded = [&](double z) {
    return static_cast<int>(std::lround(boundary_winding(loops_, projection_, h, row, column, z)));
  };
  out.clear();
  for (const Crossing& c : crossings)
    if ((c.source & kOpening) == 0) out.push_back(c);
  const auto step = [&](double z, int change) {
    for (; change > 0; --change) out.push_back({z, kRepaired, 1});
    for (; change < 0; ++change) out.push_back({z, kRepaired, -1});
  };
  double z = crossings.front().z;
  const double reach = 2 * most(box_.size()) + h;
  for (double above = h; above < reach; above *= 2) z = crossings.front().z - above;
  int before = rounded(z);
  step(z, before);
  // Handles the interval from z to `next`, which may contain a known passage.
  const auto go = [&](double next, const Crossing* known) {
    if (!(next > z)) return;
    const int after = rounded(next);
    if (known && after - before == known->sign) {
      out.push_back(*known);
    } else if (after != before) {
      double z0 = z, z1 = next;
      while (z1 - z0 > 1e-6 * h) {
        const double middle = 0.5 * (z0 + z1);
        if (middle <= z0 || middle >= z1) break;
        (rounded(middle) == before ? z0 : z1) = middle;
      }
      step(0.5 * (z0 + z1), after - before);
    }
    z = next, before = after;
  };
  for (double below = 0.5 * (crossings.front().z - z); below > 0.5 * h; below *= 0.5)
    go(crossings.front().z - below, nullptr);
  const double aside = 0.5 * kThinnestOpening * h;
  for (std::size_t k = 0; k < crossings.size(); ++k) {
    const Crossing& c = crossings[k];
    const double last = k + 1 < crossings.size() ? 0.5 * (c.z + crossings[k + 1].z) : c.z + h;
    if ((c.source & kOpening) != 0) {
      // The lost passage may be its partner: then only the winding number next to it reveals both.
      const double first = k > 0 ? 0.5 * (crossings[k - 1].z + c.z) : c.z - h;
      go(std::max(c.z - aside, first), nullptr);
      go(std::min(c.z + aside, last), &c);
    }
    go(last, nullptr);
  }
  for (double above = 2 * h; above < reach; above *= 2) go(crossings.back().z + above, nullptr);
  std::stable_sort(out.begin(), out.end(), [](const Crossing& a, const Crossing& b) { return a.z < b.z; });
  sum = 0;
  for (const Crossing& c : out) sum += c.sign;
  step(out.empty() ? 0 : out.back().z, -sum);
  return true;
}

/// Fills all grids. Returns whether a column has material where the winding number is negative.
bool fill(Volume& result, const Mesh& mesh, const std::vector<std::vector<int>>& loops, const Progress& progress,
          MeshFindings* findings = nullptr) {
  bool negative = false;
  Stats stats;
  const double grids = static_cast<double>(result.grids().size());
  double done = 0;
  for (Grid& grid : result.grids()) {
    const double middle = done + (loops.empty() ? 0.1 : 0.7) / grids;
    Filler filler(mesh, loops, grid, base::part(progress, done, middle), findings);
    filler.run(base::part(progress, middle, done += 1 / grids));
    stats.triangles_tested += filler.triangles_tested();
    negative |= filler.negative();
  }
  result.touch();
  result.count(stats);
  return negative;
}

/// Volume that rounding of the mesh's coordinates may suggest, mm³.
double feigned_volume(const Box3& box) {
  const double size = most(box.size()), far = std::max(most(box.lower), most(box.upper));
  return std::max(1e-13 * size * size * size, 64 * std::ldexp(far, -52) * size * size);
}

double most_volume(const Volume& volume) {
  double v = 0;
  for (const Grid& grid : volume.grids()) v = std::max(v, grid.volume());
  return v;
}

/// Whether a mesh that the frame's rays hardly meet has a volume nevertheless: a thin wall between rays, or a part
/// outside the box.
bool has_volume(const Mesh& mesh, const std::vector<std::vector<int>>& loops, const Box3& box) {
  const double size = most(box.size()), least = feigned_volume(box);
  if (is_flat(mesh, std::ldexp(size, -22))) return false;
  if (loops.empty() && std::abs(volume(mesh)) > least) return true;
  Volume probe(Frame{box.grown(size / 64), size / 64, "xyz"});
  fill(probe, mesh, loops, {});
  return most_volume(probe) > least;
}

/// Fraction of a mesh's volume that rays may miss without a warning: walls lie up to half a pitch off.
constexpr double kMissed = 0.1;

bool holds(const Box3& outer, const Box3& inner) {
  for (int k = 0; k < 3; ++k)
    if (inner.lower[k] < outer.lower[k] || inner.upper[k] > outer.upper[k]) return false;
  return true;
}

/// What the reference's rays miss of a closed mesh. If they hold less than the mesh encloses, the mesh may also enclose
/// some space more than once, which needs a second pass to find out.
MissedMaterial missed_by_rays(const Volume& result, const Mesh& mesh, const Box3& box, double meant) {
  if (!holds(result.frame().box, box) || !(meant > 0) || result.volume() >= (1 - kMissed) * meant) return {};
  const char axis = "xyz"[static_cast<int>(result.reference().axis())];
  Volume again(Frame{result.frame().box, result.frame().pitch, std::string(1, axis)});
  MeshFindings findings(mesh);
  fill(again, mesh, {}, {}, &findings);
  const double lost = meant - findings.tally.enclosed;
  if (lost <= kMissed * meant) return {};
  return {lost, 2 * meant / area(mesh), box};
}

/// Volume of the turned shells, as mm of rays in all grids.
double turned_lengths(const mesh::Orientation& orientation, const Volume& volume) {
  const double pitch = volume.frame().pitch;
  return orientation.turned_volume / (pitch * pitch) * static_cast<double>(volume.grids().size());
}

void conclude(const SolidMesh& solid, const MeshFindings& findings, double inside_out, MeshReport& report) {
  report.openings = solid.loops().size();
  const ColumnTally& t = findings.tally;
  report.inside_out = inside_out, report.overlap = findings.share(t.overlap);
  if (t.rays > 0) report.doubtful_rays = static_cast<double>(t.doubtful) / static_cast<double>(t.rays);
  const mesh::Orientation& o = solid.orientation();
  report.turned = o.turned, report.left_out = o.left_out, report.one_sided = o.one_sided;
  report.flipped_shells = o.turned_shells;
  if (t.inside_out > 0) report.flipped_shells += count_shells(solid.mesh(), findings.flipped);
}

}  // namespace

Volume from_mesh(const Mesh& mesh, const Frame& frame, const Progress& progress, MeshReport* report,
                 MissedMaterial* missed) {
  validate(mesh);
  if (mesh.empty()) throw std::invalid_argument("the mesh has no triangles, so it has no volume");
  Volume result(frame);
  base::report(progress, 0);
  if (report) {
    *report = {};
    count_defects(mesh, *report);
    base::report(progress, kCounted);
  }
  const Progress rest = base::part(progress, report ? kCounted : 0, 1);
  const auto [box, enclosed] = measure(mesh);
  SolidMesh solid(mesh);
  // Coordinates may have been rounded to single precision before.
  const double rounding =
      std::max(std::ldexp(most(box.size()), -22), std::ldexp(std::max(most(box.lower), most(box.upper)), -24));
  if (!solid.loops().empty() && is_flat(mesh, rounding))
    throw std::invalid_argument("the mesh is a flat sheet: it has no volume");
  solid.join_cracks(std::min(std::ldexp(most(box.size()), -20), 1e-3 * frame.pitch));
  MeshFindings findings(solid.mesh());
  const bool negative = fill(result, solid.mesh(), solid.loops(), rest, report ? &findings : nullptr);
  double inside_out = findings.share(findings.tally.inside_out + turned_lengths(solid.orientation(), result));
  if (negative && solid.orient()) {
    inside_out = findings.share(findings.tally.inside_out);
    findings = MeshFindings(solid.mesh());
    result = Volume(frame);
    fill(result, solid.mesh(), solid.loops(), base::part(progress, 0.999, 1), report ? &findings : nullptr);
  }
  if (!(most_volume(result) > 1e-6 * base::pow(most(box.size()), 3)) && !has_volume(solid.mesh(), solid.loops(), box))
    throw std::invalid_argument("the mesh has no volume: its surface encloses nothing");
  if (report) conclude(solid, findings, inside_out, *report);
  if (missed) *missed = {};
  if (missed && solid.loops().empty())
    *missed = missed_by_rays(result, solid.mesh(), box, &solid.mesh() == &mesh ? enclosed : volume(solid.mesh()));
  base::report(progress, 1);
  return result;
}

}  // namespace riffler::dexel
