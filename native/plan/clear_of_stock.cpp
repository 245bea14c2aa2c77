#include "riffler/plan/clear_of_stock.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "geom/math.hpp"
#include "plan/body_probe.hpp"
#include "plan/operation_moves.hpp"
#include "plan/pose_leads.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "riffler/sweep/carve.hpp"

namespace riffler::plan {

namespace {

constexpr std::size_t kBatch = 256;         // moves that are tested and cut together
constexpr double kSameLevel = 1e-6;         // mm
constexpr double kEnds = 0.25;              // mm, within which the ends of what is left out are found
constexpr double kLeastRun = 1;             // mm: shorter cuts between places that are left out are left out, too
constexpr double kLargestTolerance = 0.01;  // mm, largest one of the simulation
constexpr double kRapidTurn = kPi / 18;     // rad, largest turn between two rapids
constexpr std::size_t kLowered = 16;        // approaches after which the highest place of the stock is looked up again
const char* const kTainted = "the cut before it, or above it, is left out";

/// Places near moves that are left out, in square cells seen along the axis, with the greatest height of such a move.
class LeftOut {
 public:
  LeftOut(const Mat3& frame, double nearby) : frame_(frame), nearby_(nearby), cell_(0.25 * nearby) {}

  void add(const Vec3& from, const Vec3& to) {
    each(from, to, [&](const Vec3& p) {
      const int around = static_cast<int>(std::ceil(nearby_ / cell_)) + 1;
      const auto [u, v] = cell_of(p);
      for (int i = -around; i <= around; ++i)
        for (int j = -around; j <= around; ++j) {
          const auto [known, fresh] = heights_.try_emplace({u + i, v + j}, p.z);
          if (!fresh) known->second = std::max(known->second, p.z);
        }
    });
  }
  /// Whether a move comes near to such a place and is not higher.
  bool near(const Vec3& from, const Vec3& to) const {
    bool out = false;
    if (!heights_.empty())
      each(from, to, [&](const Vec3& p) {
        const auto known = heights_.find(cell_of(p));
        out = out || (known != heights_.end() && p.z <= known->second + kSameLevel);
      });
    return out;
  }

 private:
  using Cell = std::pair<long long, long long>;
  Cell cell_of(const Vec3& p) const {
    return {static_cast<long long>(std::floor(p.x / cell_)), static_cast<long long>(std::floor(p.y / cell_))};
  }
  template <class Visit>
  void each(const Vec3& from, const Vec3& to, const Visit& visit) const {
    const Vec3 a = from * frame_, b = to * frame_;
    const int steps = 1 + static_cast<int>(glm::length(b - a) / cell_);
    for (int k = 0; k <= steps; ++k) visit(glm::mix(a, b, static_cast<double>(k) / steps));
  }

  const Mat3& frame_;
  double nearby_, cell_;
  std::map<Cell, double> heights_;
};

class Clearing {
 public:
  Clearing(const SetupScene& scene, const Tool& tool, const Operation& from, const StockRule& rule)
      : scene_(scene),
        tool_(tool),
        from_(from),
        rule_(rule),
        up_(unit_axis(scene.axis, "axis")),
        frame_(operation_frame(up_, 0)),
        level_(glm::dot(from.poses.front().tip, up_)),
        stock_(scene.stock.snapshot()),
        probe_(tool, scene.stock, up_, std::min(kLargestTolerance, rule.tolerance)),
        left_out_(frame_, std::max(rule.nearby, kEnds)) {}

  bool never_touches() const {
    for (std::size_t k = 1; k < from_.poses.size(); ++k)
      if (!probe_.above(from_.poses[k - 1], from_.poses[k])) return false;
    return true;
  }

  void run(const Progress& progress) {
    made_.poses.push_back(from_.poses.front()), made_.kinds.push_back(from_.kinds.front());
    made_.feeds.push_back(from_.feeds.front());
    std::size_t begin = 0, passes = 0;
    for (std::size_t k = 1; k < from_.poses.size(); ++k) {
      if (!at_level(k)) continue;
      if (++passes % kLowered == 0) probe_.lower_top(stock_);
      pass(begin, k);
      begin = k;
      base::report(progress, static_cast<double>(k) / static_cast<double>(from_.poses.size()));
    }
    if (begin + 1 < from_.poses.size()) pass(begin, from_.poses.size() - 1);
    if (changed_) finish();
  }
  bool changed() const { return changed_; }
  std::vector<double> take_removed() { return std::move(removed_); }
  /// The moves that are left, and what is left out.
  Operation take() { return std::move(made_); }

 private:
  /// A state to which the moves can return.
  struct Mark {
    std::size_t poses;
    Volume stock;
  };
  Mark mark() const { return {made_.poses.size(), stock_.snapshot()}; }
  void restore(const Mark& to) {
    made_.poses.resize(to.poses), made_.kinds.resize(to.poses), made_.feeds.resize(to.poses);
    removed_.resize(to.poses - 1), stock_.restore(to.stock);
  }
  /// Removes rapids across that lead to an approach which is left out.
  void remove_detour() {
    const auto level = [&](std::size_t k) { return glm::dot(made_.poses[k].tip, up_) >= level_ - kSameLevel; };
    while (made_.poses.size() > 1 && level(made_.poses.size() - 2) && level(made_.poses.size() - 1))
      made_.poses.pop_back(), made_.kinds.pop_back(), made_.feeds.pop_back(), removed_.pop_back();
  }
  double cut_since(const Mark& since) const {
    double out = 0;
    for (std::size_t k = since.poses; k < made_.poses.size(); ++k)
      if (made_.kinds[k] == MoveKind::Cut) out += glm::length(made_.poses[k].tip - made_.poses[k - 1].tip);
    return out;
  }
  bool at_level(std::size_t k) const { return glm::dot(from_.poses[k].tip, up_) >= level_ - kSameLevel; }

  void add(const Pose& pose, MoveKind kind, double feed, double removed) {
    made_.poses.push_back(pose), made_.kinds.push_back(kind), made_.feeds.push_back(feed);
    removed_.push_back(removed);
  }

  /// The moves from one pose at the level of rapids to the next, from_[first] to from_[last].
  void pass(std::size_t first, std::size_t last) {
    std::size_t last_cut = 0;
    for (std::size_t k = first + 1; k <= last; ++k)
      if (from_.kinds[k] != MoveKind::Rapid) last_cut = k;
    if (last_cut == 0 && changed_) return;  // rapids to a next approach, which may be left out
    Mark begin = mark();
    if (changed_) across(from_.poses[first]);
    std::size_t run = first + 1, end = last;  // the run begins with move `run`
    for (std::size_t k = first + 1; k <= last; ++k)
      if (left_out_.near(from_.poses[k - 1].tip, from_.poses[k].tip)) {
        end = k - 1, reason_ = kTainted;
        break;
      }
    std::size_t hit = advance(run, end);
    if (hit > last) return;
    if (last_cut == 0) return cut_rapids(first, last, begin);
    changed_ = true;
    for (;;) {
      if (rule_.after != StockRule::After::Whole && hit <= end) partly(hit);
      const std::string reason = reason_;
      const bool kept = rule_.after != StockRule::After::Whole && cut_since(begin) >= kLeastRun && leave();
      if (!kept) restore(begin), remove_detour();
      const std::size_t lost = kept ? hit : run;
      if (rule_.after != StockRule::After::Resume) {
        block(reason, lost, last);
        if (rule_.after == StockRule::After::Leave)
          for (std::size_t k = lost; k <= last; ++k)
            if (!at_level(k) && !at_level(k - 1)) left_out_.add(from_.poses[k - 1].tip, from_.poses[k].tip);
        return;
      }
      const std::size_t next = resume(hit, last_cut, begin);
      block(reason, lost, next == 0 ? last : next - 1);
      if (next == 0) return;
      run = next;
      hit = advance(next, last);
      if (hit > last) return;
    }
  }
  /// Rapids alone that strike are a fault of the plan: they stay, and the program is refused.
  void cut_rapids(std::size_t first, std::size_t last, const Mark& begin) {
    restore(begin);
    for (std::size_t k = first + 1; k <= last; ++k)
      add(from_.poses[k], from_.kinds[k], from_.feeds[k],
          probe_.cut(stock_, std::span(from_.poses).subspan(k - 1, 2))[0]);
  }

  /// Cuts with the moves first … last. Returns the first one that strikes, or last + 1; `reason_` then says what.
  std::size_t advance(std::size_t first, std::size_t last) {
    for (; first <= last; first += kBatch) {
      const std::size_t end = std::min(last, first + kBatch - 1);
      if (const std::size_t hit = batch(first, end); hit <= end) return hit;
      base::still_wanted();
    }
    return last + 1;
  }
  std::size_t batch(std::size_t first, std::size_t last) {
    std::vector<std::uint32_t> ends;
    for (std::size_t k = first; k <= last; ++k)
      if (!probe_.above(from_.poses[k - 1], from_.poses[k])) ends.push_back(static_cast<std::uint32_t>(k));
    if (ends.empty() || !probe_.touches(stock_, from_.poses, ends)) {
      const std::vector<double> taken = probe_.cut(stock_, std::span(from_.poses).subspan(first - 1, last - first + 2));
      for (std::size_t k = first; k <= last; ++k) add(from_.poses[k], from_.kinds[k], from_.feeds[k], taken[k - first]);
      return last + 1;
    }
    if (first == last) return single(from_.poses[first], first) ? first + 1 : first;
    const std::size_t middle = (first + last) / 2;
    if (const std::size_t hit = batch(first, middle); hit <= middle) return hit;
    return batch(middle + 1, last);
  }
  /// Moves from the last pose to another one as in move k, if nothing strikes.
  bool single(const Pose& to, std::size_t k) { return single(to, from_.kinds[k], from_.feeds[k]); }
  bool single(const Pose& to, MoveKind kind, double feed) {
    Volume after = stock_.snapshot();
    double taken = 0;
    if (const char* why = probe_.strike(after, made_.poses.back(), to, taken)) {
      reason_ = why;
      return false;
    }
    stock_.restore(after);
    add(to, kind, feed, taken);
    return true;
  }
  /// Whether a move strikes in the present stock.
  bool strikes(const Pose& from, const Pose& to) const {
    Volume after = stock_.snapshot();
    double taken = 0;
    return probe_.strike(after, from, to, taken) != nullptr;
  }

  /// Makes the beginning of a cut that strikes, up to where it strikes.
  void partly(std::size_t k) {
    const Motion motion(made_.poses.back(), from_.poses[k]);
    const double length = glm::length(motion.to().tip - motion.from().tip);
    if (from_.kinds[k] != MoveKind::Cut || length <= kEnds) return;
    const std::string reason = reason_;
    double low = 0, high = 1;
    while ((high - low) * length > kEnds) {
      const double middle = 0.5 * (low + high);
      (strikes(motion.from(), motion.at(middle)) ? high : low) = middle;
    }
    if (low > 0) single(motion.at(low), k);
    reason_ = reason;
  }

  /// Up to the level of rapids from the last pose.
  bool leave() {
    const Pose pose = made_.poses.back();
    const std::optional<Lead> lead = leads().find(pose, level_, false);
    if (!lead) return false;
    if (lead->near != pose.tip && !single({lead->near, pose.axis}, MoveKind::Lead, rule_.plunge)) return false;
    return single({lead->top, pose.axis}, MoveKind::Rapid, 0);
  }
  /// From the level down to a pose.
  bool enter(const Pose& pose) {
    const std::optional<Lead> lead = leads().find(pose, level_, true);
    if (!lead) return false;
    across({lead->top, pose.axis});
    return single({lead->near, pose.axis}, MoveKind::Rapid, 0) && single(pose, MoveKind::Lead, rule_.plunge);
  }
  /// Comes down at the first place from move `first` on where a cut is free. `begin`: set to the state before. Returns
  /// the next move, or 0 if there is none.
  std::size_t resume(std::size_t first, std::size_t last, Mark& begin) {
    const std::string reason = reason_;
    begin = mark();
    for (std::size_t k = first; k <= last; ++k) {
      base::still_wanted();
      if (from_.kinds[k] != MoveKind::Cut) continue;
      const Pose &a = from_.poses[k - 1], &b = from_.poses[k];
      if (k > first && !strikes(a, b)) {
        if (enter(a)) return k;
        restore(begin);
        continue;
      }
      const Motion motion(a, b);
      const double length = glm::length(b.tip - a.tip);
      if (length <= 2 * kEnds || strikes(motion.at(1 - kEnds / length), b)) continue;
      double low = 0, high = 1 - kEnds / length;
      while ((high - low) * length > kEnds) {
        const double middle = 0.5 * (low + high);
        (strikes(motion.at(middle), b) ? low : high) = middle;
      }
      if (enter(motion.at(high)) && single(b, k)) return k + 1;
      restore(begin);
    }
    reason_ = reason;
    return 0;
  }

  /// Rapids from the last pose to another one at the level, in turns of at most kRapidTurn.
  void across(const Pose& pose) {
    const Pose last = made_.poses.back();
    if (last.tip == pose.tip && last.axis == pose.axis) return;
    const Motion motion(last, pose);
    const int steps = std::max(1, static_cast<int>(std::ceil(motion.angle() / kRapidTurn)));
    for (int k = 1; k < steps; ++k) add(motion.at(static_cast<double>(k) / steps), MoveKind::Rapid, 0, 0);
    add(pose, MoveKind::Rapid, 0, 0);
  }

  void block(const std::string& reason, std::size_t first, std::size_t last) {
    double length = 0;
    for (std::size_t k = first; k <= last; ++k)
      if (from_.kinds[k] == MoveKind::Cut) length += glm::length(from_.poses[k].tip - from_.poses[k - 1].tip);
    for (BlockedPlace& one : made_.blocked)
      if (rule_.after != StockRule::After::Whole && one.reason == reason) {
        one.length += length;
        return;
      }
    made_.blocked.push_back({reason, from_.poses[first].tip, length});
  }

  const PoseLeads& leads() {
    if (leads_) return *leads_;
    part_ = std::make_unique<collide::Collider>(scene_.part);
    if (!scene_.fixtures.empty()) fixtures_ = std::make_unique<collide::Collider>(joined({}, scene_.fixtures));
    if (const Mesh before = turned_stock(scene_, Mat3(1)); !before.empty())
      before_ = std::make_unique<collide::Collider>(before);
    leads_ = std::make_unique<PoseLeads>(LeadScene{*part_, before_.get(), up_, rule_.part_distance, rule_.tolerance,
                                                   fixtures_.get(), rule_.fixture_distance, false},
                                         tool_);
    return *leads_;
  }

  void finish() {
    if (removed_.empty() ||
        std::all_of(made_.kinds.begin(), made_.kinds.end(), [](MoveKind kind) { return kind == MoveKind::Rapid; })) {
      made_.poses.clear(), made_.kinds.clear(), made_.feeds.clear(), removed_.clear();
      made_.reason = made_.blocked.empty() ? "there is nothing to cut" : made_.blocked.front().reason;
      return;
    }
    across({made_.poses.back().tip, from_.poses.back().axis});
  }

  const SetupScene& scene_;
  const Tool& tool_;
  const Operation& from_;
  const StockRule& rule_;
  Vec3 up_;
  Mat3 frame_;
  double level_;
  Volume stock_;
  BodyProbe probe_;
  LeftOut left_out_;
  Operation made_;
  std::vector<double> removed_;
  bool changed_ = false;
  std::string reason_;
  std::unique_ptr<collide::Collider> part_, fixtures_, before_;
  std::unique_ptr<PoseLeads> leads_;
};

}  // namespace

std::vector<double> clear_of_stock(const SetupScene& scene, const Tool& tool, Operation& operation,
                                   const StockRule& rule, const Progress& progress) {
  if (operation.poses.empty()) return {};
  sweep::check_path(operation.poses);
  Clearing clearing(scene, tool, operation, rule);
  if (clearing.never_touches()) {
    Volume left = scene.stock.snapshot();
    sweep::CarveOptions how;
    how.progress = progress;
    return sweep::carve(left, tool, operation.poses, how).removed;
  }
  clearing.run(progress);
  std::vector<double> removed = clearing.take_removed();
  if (!clearing.changed()) return removed;
  Operation made = clearing.take();
  operation.blocked.insert(operation.blocked.end(), made.blocked.begin(), made.blocked.end());
  made.blocked = std::move(operation.blocked);
  operation = std::move(made);
  return removed;
}

}  // namespace riffler::plan
