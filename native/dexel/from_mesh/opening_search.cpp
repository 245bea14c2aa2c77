#include "dexel/from_mesh/opening_search.hpp"

#include <span>

#include "geom/math.hpp"

namespace riffler::dexel {

namespace {

constexpr std::size_t kFew = 128;                    // number of near pieces up to which each is examined
constexpr double kShortest = 1.0 / (1 << 20);        // cells; a shorter piece of a column at an edge is not halved
constexpr double kRoot = 1e-9;                       // cells; accuracy of the search along a column
constexpr double kLevel = 1e-6, kLevelBound = 2e-3;  // in K: measured and proven deviation from ½ that count as zero

/// Side, in columns and cells, of blocks that are searched column by column. The fewer boundary pieces are near, the
/// cheaper is a column compared with dividing a block.
int leaf_side(const Surroundings& around) {
  const std::size_t near = around.near.size();
  return near <= 32 ? 4 * OpeningSearch::kLeaf : near <= 128 ? 2 * OpeningSearch::kLeaf : OpeningSearch::kLeaf;
}

/// Takes up to kPoints items from the end of `items`. If there are fewer, the remaining points repeat the first.
template <class Item, class At>
std::size_t take(std::vector<Item>& items, std::array<Item, kPoints>& taken, FieldPoints& points, const At& at) {
  const std::size_t count = std::min<std::size_t>(items.size(), kPoints);
  std::copy(items.end() - static_cast<std::ptrdiff_t>(count), items.end(), taken.begin());
  items.resize(items.size() - count);
  for (std::size_t k = 0; k < kPoints; ++k) {
    const Item& item = taken[k < count ? k : 0];
    at(item, points, k);
  }
  return count;
}

}  // namespace

void OpeningSearch::enter(const Block& block, const Surroundings& within, Surroundings& around) {
  descent_.enter(within, block.centre(), glm::length(block.half()), around);
}

void OpeningSearch::block(const Block& block, const Tangent& tangent, const Surroundings& within, std::size_t depth) {
  if (depth == levels_.size()) levels_.emplace_back();
  Surroundings& around = levels_[depth];
  enter(block, within, around);
  if (block.within(leaf_side(around))) return leaf(block, tangent, around);
  parts(block, around, [&](const Block& part, const Tangent& t) { this->block(part, t, around, depth + 1); });
}

void OpeningSearch::look(const Block& block, const Surroundings& around) {
  field_.fill(pieces_, around);
  loops_.clear(), rest_ = -1;
  if (around.near.size() > kFew) return;
  for (const int k : around.near) {
    if (!pieces_[k].is_loop()) return;
    loops_.push_back(&pieces_[k].surface);
  }
  rest_ = 0.5 - kSlack - std::abs(around.far.constant()) - around.far.deviation(block.half());
}

// A surface appears under a solid angle of at most its area over the square of its distance.
bool OpeningSearch::outshone(const Block& part) const {
  const Vec3 centre = part.centre(), half = part.half();
  double rest = 4 * kPi * rest_;
  for (std::size_t k = 0; rest > 0 && k < loops_.size(); ++k) {
    const BoundaryPieces::Surface& s = *loops_[k];
    const Vec3 gap = glm::max(glm::max(centre - half - s.box.upper, s.box.lower - centre - half), Vec3(0));
    const double square = glm::dot(gap, gap);
    rest = square > 0 ? rest - s.area / square : -1;
  }
  return rest > 0;
}

void OpeningSearch::set(FieldPoints& points, std::size_t k, const Block& block) {
  const Vec3 centre = block.centre();
  points.x[k] = centre.x, points.y[k] = centre.y, points.z[k] = centre.z;
  const Vec3 half = block.half();
  points.half_x[k] = half.x, points.half_y[k] = half.y, points.half_z[k] = half.z;
}

void OpeningSearch::set(FieldPoints& points, std::size_t k, const Piece& piece, double z) {
  points.x[k] = piece.row, points.y[k] = piece.column, points.z[k] = z;
  points.half_x[k] = points.half_y[k] = 0, points.half_z[k] = piece.half();
}

void OpeningSearch::leaf(const Block& block, const Tangent& tangent, const Surroundings& around) {
  look(block, around);
  curved_ = around.far.curvature_along(block.half());
  columns(block, tangent, around.far.curved(block.half()));
  while (!segments_.empty() || !doubts_.empty()) {
    // Prefer the list that fills the lanes.
    if (segments_.empty() || doubts_.size() >= kPoints)
      doubts();
    else
      segments();
  }
  while (!roots_.empty()) roots();
  normals();
}

void OpeningSearch::columns(const Block& block, const Tangent& t, double curved) {
  if (!field_.smooth() && !block.within(kLeaf)) {
    const Vec3 half = block.half();
    parts(block, curved, [&](const Block& part, const Tangent& inner) {
      const bool halved = glm::all(glm::lessThanEqual(part.half(), 0.5 * half));
      columns(part, inner, halved ? 0.25 * curved : curved);
    });
    return;
  }
  const Vec3 centre = block.centre();
  const double along = std::abs(t.gradient.z) * block.half().z + t.remainder + kSlack;
  for (int i = block.i0; i < block.i1; ++i)
    for (int j = block.j0; j < block.j1; ++j)
      if (std::abs(t.phase + t.gradient.x * (i - centre.x) + t.gradient.y * (j - centre.y)) <= along)
        segments_.push_back({i, j, block.z0, block.z1});
}

void OpeningSearch::segments() {
  std::array<Piece, kPoints> pieces;
  FieldPoints points;
  FieldValues values;
  const std::size_t count = take(segments_, pieces, points,
                                 [](const Piece& p, FieldPoints& to, std::size_t k) { set(to, k, p, p.middle()); });
  field_.at(points, false, values);
  for (std::size_t k = 0; k < count; ++k) {
    const double half = points.half_z[k], phase = values.phase[k], slope = values.gz[k];
    const double curvature = field_.rays() + curved_ + values.curvature[k];
    if (std::abs(phase) > std::abs(slope) * half + 0.5 * curvature * half * half + kSlack * half) continue;
    if (std::abs(slope) > 2 * curvature * half)
      newton({pieces[k], points.z[k], slope > 0, 0}, phase, slope);
    else
      doubts_.push_back({pieces[k], phase, slope});
  }
}

void OpeningSearch::doubts() {
  std::array<Doubt, kPoints> taken;
  FieldPoints points;
  const std::size_t count = take(doubts_, taken, points, [](const Doubt& d, FieldPoints& to, std::size_t k) {
    set(to, k, d.piece, d.piece.middle());
  });
  double slopes[kPoints], variation[kPoints];
  for (std::size_t k = 0; k < kPoints; ++k) slopes[k] = taken[k < count ? k : 0].slope;
  field_.variation(points, slopes, curved_, variation);
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [piece, phase, slope] = taken[k];
    const double half = points.half_z[k], z = points.z[k];
    if (std::abs(phase) > variation[k] + kSlack * half) continue;
    // A column in the plane of a flat opening, where K is ½ everywhere: either side is correct.
    const bool level = std::abs(phase) + std::abs(slope) * half < kLevel && variation[k] < kLevelBound;
    if (half > kShortest && !level) {
      segments_.push_back({piece.row, piece.column, piece.z0, z});
      segments_.push_back({piece.row, piece.column, z, piece.z1});
      continue;
    }
    // At an edge, the decisions for crossings also decide on which side of it the column passes.
    const int change = rounded_(piece.row, piece.column, piece.z1) - rounded_(piece.row, piece.column, piece.z0);
    for (int n = 0; n < std::abs(change); ++n) add(piece, z, change > 0);
  }
}

void OpeningSearch::roots() {
  std::array<Root, kPoints> taken;
  FieldPoints points;
  FieldValues values;
  const std::size_t count =
      take(roots_, taken, points, [](const Root& r, FieldPoints& to, std::size_t k) { set(to, k, r.piece, r.z); });
  field_.at(points, false, values);
  for (std::size_t k = 0; k < count; ++k) newton(taken[k], values.phase[k], values.gz[k]);
}

void OpeningSearch::newton(Root root, double phase, double slope) {
  const double z0 = root.piece.z0, z1 = root.piece.z1, length = z1 - z0, room = 1e-3 * length;
  const double move = -phase / slope;
  root.z += move;
  if (root.z < z0 - 0.5 * length || root.z > z1 + 0.5 * length) return;
  const bool done = std::abs(move) < kRoot * (1 + std::abs(root.z)) ||
                    (root.steps > 0 && move * move < kRoot * length) || root.steps == 29;
  ++root.steps;
  if (!done)
    roots_.push_back(root);
  else if (root.z >= z0 - room && root.z <= z1 + room)
    add(root.piece, root.z, root.rising);
}

void OpeningSearch::add(const Piece& piece, double z, bool rising) {
  out_.push_back({piece.row, piece.column, z, rising ? 1 : -1, {}});
}

void OpeningSearch::normals() {
  if (!grid_.has_normals()) return;
  for (; complete_ < out_.size(); complete_ += kPoints) {
    FieldPoints points;
    FieldValues values;
    const auto passages = std::span(out_).subspan(complete_);
    for (std::size_t k = 0; k < kPoints; ++k) {
      const Passage& p = passages[k < passages.size() ? k : 0];
      set(points, k, {p.row, p.column, p.z, p.z}, p.z);
    }
    field_.at(points, true, values);
    for (std::size_t k = 0; k < std::min<std::size_t>(kPoints, passages.size()); ++k) {
      const Vec3 gradient(values.gx[k], values.gy[k], values.gz[k]);
      const double length = glm::length(gradient);
      const Vec3 normal = length > 0 ? gradient / -length : Vec3(0, 0, -passages[k].sign);
      passages[k].normal = PackedNormal::pack(to_world(grid_.axis(), normal));
    }
  }
  complete_ = out_.size();
}

}  // namespace riffler::dexel
