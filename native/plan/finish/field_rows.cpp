#include "plan/finish/field_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "plan/finish/row_index.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/tool/outline.hpp"

namespace riffler::plan {

namespace {

constexpr int kMostHalves = 10;
constexpr int kBorderHalves = 6;
constexpr double kStep = 2;  // rise between two places, in their distance, from which there may be a step
constexpr int kNear = 2;     // radius, in places, of the neighbourhood of a place where too much material stays

/// A point to be cut: at a place, or between two places where a border of the selected faces runs.
struct Sample {
  SurfacePoint at;
  std::size_t place;
  double value;
};

/// The samples and the grid's edges between two rows. Edge 2 k leads from place k along x, edge 2 k + 1 along y.
struct Band {
  double low, high;
  std::vector<std::size_t> samples, edges;

  double middle() const { return 0.5 * (low + high); }
};

struct NewRow {
  std::vector<CutPiece> pieces;
  std::vector<BlockedPlace> blocked;
};

class Fields {
 public:
  Fields(const PatternScene& scene, const RowField& field)
      : scene_(scene),
        field_(field),
        outline_(scene.tool),
        cusp_(kCuspShare * scene.options.cusp),
        index_(scene.part, 2 * scene.profile.spacing(cusp_)),
        meant_(field.grid.size()) {}

  PatternRows run(const Progress& progress) {
    out_.spacing = scene_.profile.spacing(cusp_);
    add(rows(field_.first, {}, base::part(progress, 0, 0.5)), out_.rows);
    look_at_places(base::part(progress, 0.5, 0.6));
    std::vector<Band> bands = first_bands();
    for (int k = 0; k < kMostHalves && !bands.empty(); ++k) {
      const Progress rest = base::part(progress, 0.6 + 0.4 * k / kMostHalves, 0.6 + 0.4 * (k + 1) / kMostHalves);
      bands = halves(bands, rest);
    }
    base::report(progress, 1);
    return std::move(out_);
  }

 private:
  std::size_t other(std::size_t edge) const {
    return edge / 2 + (edge % 2 ? static_cast<std::size_t>(field_.grid.columns) : 1);
  }

  std::vector<NewRow> rows(const std::vector<double>& values, const std::vector<PlaceSet>& near,
                           const Progress& progress) const {
    std::vector<NewRow> out(values.size());
    base::parallel_for(
        values.size(), 1,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k)
            out[k].pieces = field_.row(values[k], near.empty() ? nullptr : &near[k], out[k].blocked);
        },
        progress);
    return out;
  }

  void add(std::vector<NewRow> rows, std::size_t& count) {
    for (NewRow& row : rows) {
      count += !row.pieces.empty();
      for (CutPiece& piece : row.pieces) index_.add(piece.tips), out_.pieces.push_back(std::move(piece));
      if (&count == &out_.rows) add_blocked(row.blocked, out_.blocked);
    }
  }

  bool meant(const SurfacePoint& p) const {
    if (!scene_.surface.meant(p)) return false;
    const double slope = scene_.surface.touched_slope(p);
    return slope >= field_.least_slope && slope <= field_.most_slope;
  }

  void look_at_places(const Progress& progress) {
    const std::size_t n = field_.grid.size();
    std::vector<SurfacePoint> places(n);
    base::parallel_for(
        n, 256,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) {
            if (k % 64 == 0) base::still_wanted();
            places[k] = scene_.surface.at(field_.grid.place(k));
            meant_[k] = meant(places[k]);
          }
        },
        base::part(progress, 0, 0.8));
    std::vector<std::vector<Sample>> found(n);
    base::parallel_for(
        n, 256,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) {
            if (meant_[k]) found[k].push_back({places[k], k, field_.values[k]});
            for (const std::size_t edge : {2 * k, 2 * k + 1})
              if (leads_on(edge) && meant_[k] != meant_[other(edge)]) found[k].push_back(border(edge, places));
          }
        },
        base::part(progress, 0.8, 1));
    for (const std::vector<Sample>& some : found) samples_.insert(samples_.end(), some.begin(), some.end());
    if (field_.flat) add_flat(places);
  }
  /// Whether the grid has a place at the other end of an edge.
  bool leads_on(std::size_t edge) const {
    const auto columns = static_cast<std::size_t>(field_.grid.columns);
    return edge % 2 ? edge / 2 + columns < field_.grid.size() : (edge / 2 + 1) % columns != 0;
  }
  /// The last selected point on an edge from a selected place to one that is not selected.
  Sample border(std::size_t edge, const std::vector<SurfacePoint>& places) const {
    std::size_t in = edge / 2, out = other(edge);
    if (!meant_[in]) std::swap(in, out);
    Sample last{places[in], in, field_.values[in]};
    double low = 0, high = 1;
    for (int i = 0; i < kBorderHalves; ++i) {
      const double share = 0.5 * (low + high);
      const SurfacePoint p = scene_.surface.at(glm::mix(field_.grid.place(in), field_.grid.place(out), share));
      (meant(p) ? low : high) = share;
      if (low == share) last = {p, in, glm::mix(field_.values[in], field_.values[out], share)};
    }
    return last;
  }

  /// Reports the selected faces that are less steep than this pattern finishes.
  void add_flat(const std::vector<SurfacePoint>& places) {
    const double area = field_.grid.spacing * field_.grid.spacing;
    for (const SurfacePoint& p : places)
      if (scene_.surface.meant(p) && scene_.surface.touched_slope(p) < field_.least_slope)
        add_blocked({{field_.flat, p.tip, area / out_.spacing}}, out_.blocked);
  }

  std::vector<Band> first_bands() const {
    std::vector<Band> out;
    const std::vector<double>& v = field_.first;
    if (v.empty()) return out;
    // The last band reaches up to the largest value.
    for (std::size_t k = 0; k < v.size(); ++k)
      out.push_back({v[k], k + 1 < v.size() ? v[k + 1] : std::max(v[k], *largest()), {}, {}});
    const auto each = [&](double low, double high, const auto& visit) {
      if (!(high >= v.front())) high = v.front(), low = std::max(low, high);
      auto k = static_cast<std::size_t>(std::upper_bound(v.begin(), v.end(), low) - v.begin());
      for (k = k > 0 ? k - 1 : 0; k < out.size() && out[k].low <= high; ++k) visit(out[k]);
    };
    const PlaceGrid& grid = field_.grid;
    for (std::size_t k = 0; k < grid.size(); ++k) {
      const double here = field_.values[k];
      for (const std::size_t edge : {2 * k, 2 * k + 1}) {
        if (!leads_on(edge)) continue;
        const double there = field_.values[other(edge)];
        if (here == there || !std::isfinite(here) || !std::isfinite(there)) continue;
        each(std::min(here, there), std::max(here, there), [&](Band& band) { band.edges.push_back(edge); });
      }
    }
    for (std::size_t i = 0; i < samples_.size(); ++i)
      each(samples_[i].value, samples_[i].value, [&](Band& band) { band.samples.push_back(i); });
    return out;
  }
  std::vector<double>::const_iterator largest() const {
    return std::max_element(field_.values.begin(), field_.values.end());
  }

  /// Whether the rows leave material higher than the cusp at a point. In the middle between two rows, the ridge at
  /// twice the distance of the nearest row counts as well.
  bool stands(const SurfacePoint& p, bool middle) const {
    const std::optional<Vec3> row = index_.nearest(p.tip);
    if (!row) return true;
    if (middle &&
        scene_.profile.ridge(2 * geom::hypot(p.tip.x - row->x, p.tip.y - row->y), 2 * (p.tip.z - row->z)) > cusp_)
      return true;
    const Vec3 off = p.landing.point - *row;
    return outline_.nearest(geom::hypot(off.x, off.y), off.z).distance - scene_.options.allowance > cusp_ + field_.lift;
  }

  /// Whether too much material stays at the foot of a wall that begins within a band and rises above it: no row is
  /// below the foot.
  bool stands_at_foot(const Band& band, std::size_t a, std::size_t b) const {
    if (!field_.foot) return false;
    const auto [least, most] = std::minmax(field_.values[a], field_.values[b]);
    const double step = kStep * field_.grid.spacing;  // the floor may be lower at the place than at the wall
    if (!(least >= band.low - step && least < band.high && most >= band.high && most - least >= step)) return false;
    base::still_wanted();
    const std::optional<SurfacePoint> p = field_.foot(a, b, band.high);
    return p && p->tip.z >= band.low && meant(*p) && stands(*p, false);
  }

  /// The places near those of a band where too much material stays; empty if there are none.
  PlaceSet open_places(const Band& band) const {
    std::vector<std::size_t> open;
    for (const std::size_t i : band.samples)
      if (stands(samples_[i].at, false)) open.push_back(samples_[i].place);
    for (const std::size_t edge : band.edges) {
      const std::size_t a = edge / 2, b = other(edge);
      if (stands_at_foot(band, a, b)) open.push_back(a), open.push_back(b);
      if ((field_.values[a] < band.middle()) == (field_.values[b] < band.middle())) continue;
      base::still_wanted();
      const std::optional<SurfacePoint> p = field_.between(a, b, band.middle());
      if (p && meant(*p) && stands(*p, true)) open.push_back(a), open.push_back(b);
    }
    if (open.empty()) return {};
    PlaceSet near(field_.grid.size(), 0);
    const int columns = field_.grid.columns, rows = field_.grid.rows;
    for (const std::size_t k : open) {
      const int column = static_cast<int>(k % static_cast<std::size_t>(columns)),
                row = static_cast<int>(k / static_cast<std::size_t>(columns));
      for (int r = std::max(0, row - kNear); r <= std::min(rows - 1, row + kNear); ++r)
        for (int c = std::max(0, column - kNear); c <= std::min(columns - 1, column + kNear); ++c)
          near[field_.grid.index(c, r)] = 1;
    }
    return near;
  }

  /// Adds rows in the middle of the bands where needed. Returns the bands on both sides of the new rows.
  std::vector<Band> halves(const std::vector<Band>& bands, const Progress& progress) {
    std::vector<PlaceSet> near(bands.size());
    base::parallel_for(
        bands.size(), 1,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k)
            if (bands[k].high - bands[k].low > field_.finest) near[k] = open_places(bands[k]);
        },
        base::part(progress, 0, 0.5));
    std::vector<Band> out;
    std::vector<double> values;
    std::vector<PlaceSet> where;
    for (std::size_t k = 0; k < bands.size(); ++k) {
      if (near[k].empty()) continue;
      values.push_back(bands[k].middle());
      out.push_back(half(bands[k], near[k], bands[k].low, values.back()));
      out.push_back(half(bands[k], near[k], values.back(), bands[k].high));
      where.push_back(std::move(near[k]));
    }
    add(rows(values, where, base::part(progress, 0.5, 1)), out_.added);
    return out;
  }

  Band half(const Band& band, const PlaceSet& near, double low, double high) const {
    Band out{low, high, {}, {}};
    for (const std::size_t i : band.samples)
      if (near[samples_[i].place] && samples_[i].value >= low && samples_[i].value <= high) out.samples.push_back(i);
    for (const std::size_t edge : band.edges) {
      const std::size_t a = edge / 2, b = other(edge);
      if (!near[a] && !near[b]) continue;
      const auto [least, most] = std::minmax(field_.values[a], field_.values[b]);
      if (least <= high && most >= low) out.edges.push_back(edge);
    }
    return out;
  }

  const PatternScene& scene_;
  const RowField& field_;
  tool::Outline outline_;
  double cusp_;
  RowIndex index_;
  PlaceSet meant_;
  std::vector<Sample> samples_;
  PatternRows out_;
};

}  // namespace

PatternRows field_rows(const PatternScene& scene, const RowField& field, const Progress& progress) {
  return Fields(scene, field).run(progress);
}

}  // namespace riffler::plan
