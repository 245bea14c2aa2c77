#include "verify/simulate.hpp"

#include <algorithm>
#include <bit>

namespace riffler::verify {

namespace {

/// Moves that are probed, then cut, together.
constexpr std::size_t kBatch = 256;
/// The first collisions of a slab are all measured; afterwards one in sixteen.
constexpr std::uint64_t kMeasured = 256;
/// Number of times a move is halved to decide what came first, cutter or shank.
constexpr int kHalvings = 12;

Kind kind_of(Member member) {
  return member == Member::Shank ? Kind::Shank : member == Member::Holder ? Kind::Holder : Kind::Unknown;
}

/// Cuts a slab of the stock with the moves that can touch it.
class StockSimulation {
 public:
  StockSimulation(const SlabPlace& place, const Moves& moves, SlabTiles& state, SlabReport& report, VerifyStats& stats)
      : place_(place),
        bench_(place.grid, place.slab, place.tolerance),
        moves_(moves),
        state_(state),
        report_(report),
        stats_(stats) {}

  void run(std::size_t first, const SlabSaved& saved);

 private:
  struct Touched {
    std::size_t move;
    Moves::Touch touch;
  };
  using Batch = std::span<const Touched>;
  struct Strike {
    SlabTiles state;  // without the material that the cutter had removed by then
    Pose from, to;
  };

  void pass(Batch batch);
  void cut(Batch batch);
  bool alarm(Batch batch);
  bool near_material(std::size_t move) const;
  void find_rapids(Batch batch, std::span<const double> taken, SlabTiles before);
  void find_strikes(const Touched& touched);
  bool measured(std::size_t move) const;
  bool strike(SlabTiles& state, const Probe& probe, const Touched& touched, double t0, double t1, int halvings,
              Strike& out);

  const SlabPlace& place_;
  Workbench bench_;
  const Moves& moves_;
  SlabTiles& state_;
  SlabReport& report_;
  VerifyStats& stats_;
};

void StockSimulation::run(std::size_t first, const SlabSaved& saved) {
  // Material only decreases, so what cannot touch it now cannot touch it later.
  const Box3 box = material_box(bench_.grid(), bench_.slab(), state_);
  if (box.empty()) return;
  std::vector<Touched> touched;
  std::vector<std::size_t> cuts;
  moves_.for_each(first, box, [&](std::size_t i, Moves::Touch touch) {
    if (!place_.probed) touch = static_cast<Moves::Touch>(touch & Moves::Cutter);
    if (touch == Moves::None) return;
    touched.push_back({i, touch});
    if (touch & Moves::Cutter) cuts.push_back(i);
  });
  stats_.skipped += moves_.size() - first - touched.size();
  if (touched.empty()) return;
  ++stats_.slabs;
  const SlabTiles before = state_;
  for (std::size_t begin = 0; begin < touched.size();) {
    std::size_t end = begin + 1;
    while (end < touched.size() && end - begin < kBatch &&
           moves_.tool(touched[end].move) == moves_.tool(touched[begin].move))
      ++end;
    pass(Batch(touched).subspan(begin, end - begin));
    if (saved) saved(moves_.row(touched[end - 1].move), state_);
    begin = end;
  }
  if (place_.surface) find_gouges(*place_.surface, place_.part, bench_, before, state_, moves_, cuts, report_.events);
}

/// Tests shank and holder on the material before the batch: what they do not touch now they never touch. On contact the
/// batch is halved, down to the single move.
void StockSimulation::pass(Batch batch) {
  if (!alarm(batch)) return cut(batch);
  if (batch.size() == 1) {
    find_strikes(batch[0]);
    return cut(batch);
  }
  ++stats_.bisections;
  pass(batch.first(batch.size() / 2));
  pass(batch.subspan(batch.size() / 2));
}

bool StockSimulation::near_material(std::size_t move) const {
  const dexel::Grid& grid = bench_.grid();
  const Slab& slab = bench_.slab();
  for (const Rod& rod : moves_.shapes(move).probe_rods) {
    const Box3 box = to_local(grid.axis(), moves_.swept(rod, move));
    const auto tile = [&](double at, double lower, int low, int high) {
      return static_cast<int>(std::clamp(std::floor((at - lower) / (grid.pitch() * dexel::kTileSide)),
                                         static_cast<double>(low), static_cast<double>(high)));
    };
    const double half = 0.5001 * grid.pitch();
    const int u0 = tile(box.lower.x - half, grid.box().lower.x, slab.u0, slab.u1 - 1),
              u1 = tile(box.upper.x + half, grid.box().lower.x, slab.u0, slab.u1 - 1),
              v0 = tile(box.lower.y - half, grid.box().lower.y, slab.v0, slab.v1 - 1),
              v1 = tile(box.upper.y + half, grid.box().lower.y, slab.v0, slab.v1 - 1);
    for (int u = u0; u <= u1; ++u)
      for (int v = v0; v <= v1; ++v) {
        const dexel::Tile& t = *state_[static_cast<std::size_t>((u - slab.u0) * (slab.v1 - slab.v0) + v - slab.v0)];
        if (!t.spans.empty() && t.reach.near < box.upper.z && t.reach.far > box.lower.z) return true;
      }
  }
  return false;
}

bool StockSimulation::alarm(Batch batch) {
  std::vector<std::uint32_t> ends;
  for (const Touched& t : batch)
    if ((t.touch & Moves::Probes) && near_material(t.move)) ends.push_back(moves_.end(t.move));
  if (ends.empty()) return false;
  ++stats_.probes;
  stats_.probed_moves += ends.size();
  return bench_.touches(state_, moves_.shapes(batch[0].move).small, moves_.poses(), ends);
}

void StockSimulation::cut(Batch batch) {
  std::vector<Touched> cuts;
  std::vector<std::uint32_t> ends;
  for (const Touched& t : batch)
    if (t.touch & Moves::Cutter) cuts.push_back(t), ends.push_back(moves_.end(t.move));
  if (cuts.empty()) return;
  stats_.moves += cuts.size();
  SlabTiles before = state_;
  const std::vector<double> taken = bench_.cut(state_, moves_.shapes(cuts[0].move).cutter, moves_.poses(), ends);
  if (!place_.probed) return;
  for (std::size_t k = 0; k < cuts.size(); ++k)
    if (taken[k] > 0) report_.removed.emplace_back(moves_.row(cuts[k].move), taken[k]);
  find_rapids(cuts, taken, std::move(before));
}

/// A rapid that removes more than the tolerance from some ray is in material; less may be rounding, or what a rotating
/// move before it left of its surface. Each such rapid is cut separately to measure its volume.
void StockSimulation::find_rapids(Batch cuts, std::span<const double> taken, SlabTiles before) {
  const double least = place_.tolerance * bench_.grid().least_area();
  std::vector<std::uint32_t> ends;  // moves not cut yet
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    const std::size_t i = cuts[k].move;
    if (!moves_.rapid(i) || !(taken[k] > least)) {
      ends.push_back(moves_.end(i));
      continue;
    }
    bench_.cut(before, moves_.shapes(i).cutter, moves_.poses(), ends);
    ends.clear();
    SlabTiles after = bench_.after(before, moves_.shapes(i).cutter, moves_.from(i), moves_.to(i));
    const Loss loss = loss_of(bench_.grid(), bench_.slab(), before, after);
    if (loss.longest > place_.tolerance)
      report_.events.push_back({Kind::Rapid, Member::Cutter, -1, moves_.row(i), taken[k], loss.longest, loss.point});
    before = std::move(after);
  }
}

/// Whether the probe collides with material that the cutter has not removed yet. If it is clear of the material before
/// the move: no. If it touches what the cutter leaves after the move: yes. In between, as in a plunge with a thin
/// shank, the halves of the move are examined one after the other.
bool StockSimulation::strike(SlabTiles& state, const Probe& probe, const Touched& touched, double t0, double t1,
                             int halvings, Strike& out) {
  const std::size_t move = touched.move;
  const Motion motion(moves_.from(move), moves_.to(move));
  const Pose poses[] = {t0 > 0 ? motion.at(t0) : motion.from(), t1 < 1 ? motion.at(t1) : motion.to()};
  const std::uint32_t end = 1;
  ++stats_.probes, ++stats_.probed_moves;
  const bool struck = bench_.touches(state, probe.small, poses, {&end, 1});
  const bool cuts = touched.touch & Moves::Cutter;
  if (!cuts) {
    if (struck) out = {state, poses[0], poses[1]};
    return struck;
  }
  SlabTiles after = bench_.after(state, moves_.shapes(move).cutter, poses[0], poses[1]);
  if (!struck) {
    state = std::move(after);
    return false;
  }
  if (bench_.touches(after, probe.small, poses, {&end, 1})) {
    out = {std::move(after), poses[0], poses[1]};
    return true;
  }
  if (halvings == 0) {
    state = std::move(after);
    return false;
  }
  const double middle = (t0 + t1) / 2;
  return strike(state, probe, touched, t0, middle, halvings - 1, out) ||
         strike(state, probe, touched, middle, t1, halvings - 1, out);
}

void StockSimulation::find_strikes(const Touched& touched) {
  for (const Probe& probe : moves_.shapes(touched.move).probes) {
    SlabTiles state = state_;
    Strike found;
    if (!strike(state, probe, touched, 0, 1, kHalvings, found)) continue;
    Loss loss{0, 0, moves_.to(touched.move).tip};
    if (measured(touched.move))
      loss = loss_of(bench_.grid(), bench_.slab(), found.state,
                     bench_.after(found.state, probe.real, found.from, found.to));
    ++report_.strikes;
    report_.events.push_back(
        {kind_of(probe.member), probe.member, -1, moves_.row(touched.move), loss.volume, loss.longest, loss.point});
  }
}

/// Measuring the volume costs more than detecting the collision, and a holder in material stays there for many moves.
/// After the first collisions some are skipped, by a number that edits elsewhere do not change.
bool StockSimulation::measured(std::size_t move) const {
  if (report_.strikes < kMeasured) return true;
  const Vec3& tip = moves_.to(move).tip;
  std::uint64_t mixed = 0;
  for (int i = 0; i < 3; ++i) mixed = (mixed ^ std::bit_cast<std::uint64_t>(tip[i])) * 0x9E3779B97F4A7C15;
  return mixed >> 60 == 0;
}

/// Tests the moves' whole tool on one slab of a fixture.
class FixtureProbe {
 public:
  FixtureProbe(const SlabPlace& place, const Moves& moves, const SlabTiles& state, SlabReport& report,
               VerifyStats& stats)
      : place_(place),
        bench_(place.grid, place.slab, place.tolerance),
        moves_(moves),
        state_(state),
        report_(report),
        stats_(stats) {}

  void run(std::size_t first) {
    const Box3 box = material_box(bench_.grid(), bench_.slab(), state_);
    if (box.empty()) return;
    std::vector<std::size_t> touched;
    moves_.for_each(first, box, [&](std::size_t i, Moves::Touch) { touched.push_back(i); });
    stats_.skipped += moves_.size() - first - touched.size();
    stats_.slabs += !touched.empty();
    for (std::size_t begin = 0; begin < touched.size();) {
      std::size_t end = begin + 1;
      while (end < touched.size() && end - begin < kBatch && moves_.tool(touched[end]) == moves_.tool(touched[begin]))
        ++end;
      pass(std::span(touched).subspan(begin, end - begin));
      begin = end;
    }
  }

 private:
  void pass(std::span<const std::size_t> batch) {
    std::vector<std::uint32_t> ends;
    for (const std::size_t i : batch) ends.push_back(moves_.end(i));
    ++stats_.probes, stats_.probed_moves += batch.size();
    const ToolShapes& tool = moves_.shapes(batch[0]);
    if (!bench_.touches(state_, tool.cutter, moves_.poses(), ends) &&
        !bench_.touches(state_, tool.small, moves_.poses(), ends))
      return;
    if (batch.size() == 1) return find(batch[0]);
    ++stats_.bisections;
    pass(batch.first(batch.size() / 2));
    pass(batch.subspan(batch.size() / 2));
  }

  void find(std::size_t i) {
    const ToolShapes& tool = moves_.shapes(i);
    const auto look = [&](Kind kind, Member member, std::span<const sweep::ConvexGroup> shape) {
      const Loss loss =
          loss_of(bench_.grid(), bench_.slab(), state_, bench_.after(state_, shape, moves_.from(i), moves_.to(i)));
      if (!(loss.longest > (member == Member::Cutter ? place_.tolerance : 0))) return false;
      report_.events.push_back({kind, member, place_.fixture, moves_.row(i), loss.volume, loss.longest, loss.point});
      return true;
    };
    bool known = look(Kind::Fixture, Member::Cutter, tool.cutter);
    const std::uint32_t end = moves_.end(i);
    for (const Probe& probe : tool.probes) {
      if (known && probe.member == Member::Beyond) continue;
      if (!bench_.touches(state_, probe.small, moves_.poses(), {&end, 1})) continue;
      known |= look(probe.member == Member::Beyond ? Kind::Unknown : Kind::Fixture, probe.member, probe.real);
    }
  }

  const SlabPlace& place_;
  Workbench bench_;
  const Moves& moves_;
  const SlabTiles& state_;
  SlabReport& report_;
  VerifyStats& stats_;
};

}  // namespace

void simulate(const SlabPlace& place, const Moves& moves, std::size_t first, SlabTiles& tiles, SlabReport& report,
              VerifyStats& stats, const SlabSaved& saved) {
  if (place.fixture < 0)
    StockSimulation(place, moves, tiles, report, stats).run(first, saved);
  else
    FixtureProbe(place, moves, tiles, report, stats).run(first);
}

}  // namespace riffler::verify
