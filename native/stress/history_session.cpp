#include "stress/history_session.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "riffler/dexel/file/file.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/sweep/history.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/scenario.hpp"
#include "stress/thread_count.hpp"

namespace riffler::stress {

namespace {

using sweep::History;
using sweep::HistoryStroke;
using sweep::StrokeId;

/// A stroke in the session's own list.
struct Listed {
  StrokeId id;
  HistoryStroke stroke;
  bool enabled = true;
};

/// An edit of a history and of the session's list.
struct Edit {
  std::string name;
  std::function<void(History&, const Progress&)> of_history;
  std::function<void(std::vector<Listed>&)> of_list;
};

class Session {
 public:
  Session(const HistoryOptions& options, std::uint64_t session, HistoryResults& out)
      : options_(options), number_(session), out_(out), random_(options.seed, 0x815, session), stage_(draw()) {}
  void run();

 private:
  Stage draw();
  Volume draw_base();
  HistoryStroke draw_stroke();
  Edit draw_edit();
  Edit draw_insertion();
  Volume replay() const;
  bool check(int edit, const Edit& what);
  std::string problem(History& history, const Edit& edit, const std::vector<std::uint8_t>& expected);
  std::string problem_of_cancel(History& history, const Edit& edit);
  std::size_t any() { return static_cast<std::size_t>(random_.below(static_cast<int>(list_.size()))); }

  const HistoryOptions& options_;
  std::uint64_t number_;
  HistoryResults& out_;
  Random random_;
  std::vector<Tool> tools_;
  Stage stage_;
  std::optional<Volume> base_, mask_;
  std::vector<Move> moves_;
  std::vector<Listed> list_;
  std::vector<History> histories_;
  StrokeId next_ = 1;  // ids ascend from 1
};

/// A third of the sessions have about ten blocks of tiles; the others have the sizes of the stress run of carving.
Stage Session::draw() {
  Stage stage = draw_stage(random_, random_.one_of({"ball", "flat", "fillet", "taper-ball", "disc", "corner-rounder"}));
  if (stage.setting == Setting::Usual && random_.one_in(2))
    for (int k = 0; k < 2; ++k)
      stage.frame.box.upper[k] = stage.frame.box.lower[k] + stage.frame.pitch * (90 + random_.below(120));
  tools_.push_back(stage.tool);
  const double r = stage.tool.profile().max_radius(), length = stage.tool.length();
  tools_.push_back(cutters::ball(random_.uniform(0.5, 2) * r, std::max(length, 2 * r)));
  tools_.push_back(cutters::flat(random_.uniform(0.5, 2) * r, length));
  return stage;
}

Volume Session::draw_base() {
  if (random_.one_in(8)) return Volume(stage_.frame);
  Volume base = Volume::block(stage_.frame);
  for (int k = random_.below(3); k > 0; --k) {
    const HistoryStroke s = draw_stroke();
    sweep::carve(base, s.tool, s.poses);
  }
  return base;
}

/// A few moves from the degenerate limits, joined where their axes allow it; sometimes the same stroke again, a single
/// pose, or a stroke that touches no ray.
HistoryStroke Session::draw_stroke() {
  if (!list_.empty() && random_.one_in(10)) return list_[any()].stroke;
  HistoryStroke out{tools_[static_cast<std::size_t>(random_.below(3))], {}};
  out.mode = random_.one_in(3) ? sweep::CarveMode::Add : sweep::CarveMode::Remove;
  if (mask_ && random_.one_in(5)) out.protect = mask_;
  const int moves = random_.one_in(12) ? 0 : 1 + random_.below(4);
  for (int k = 0; k <= moves; ++k) {
    const Move move = draw_move(random_, stage_, histories_.empty() ? *base_ : histories_[0].volume(), moves_);
    if (moves_.size() < 64) moves_.push_back(move);
    out.tolerance = move.tolerance;
    for (const Pose& pose : {move.from, move.to}) {
      out.poses.push_back(pose);
      try {
        sweep::check_path(out.poses);
      } catch (const std::invalid_argument&) {
        out.poses.pop_back();  // opposite to the axis before
      }
      if (moves == 0) return out;
    }
  }
  return out;
}

Edit Session::draw_insertion() {
  const HistoryStroke stroke = draw_stroke();
  const bool last = list_.empty() || random_.one_in(2);
  const std::size_t at = last ? list_.size() : any();
  const StrokeId before = last ? 0 : list_[at].id, id = next_++;
  return {last ? "add" : "insert",
          [=](History& h, const Progress& p) { last ? h.add(stroke, p) : h.insert(stroke, before, p); },
          [=](std::vector<Listed>& list) {
            list.insert(list.begin() + static_cast<std::ptrdiff_t>(at), {id, stroke, true});
          }};
}

Edit Session::draw_edit() {
  if (list_.empty()) return draw_insertion();
  const std::size_t at = any(), other = any();
  const StrokeId id = list_[at].id, before = list_[other].id;
  const auto place = [](auto& list, std::size_t k) { return list.begin() + static_cast<std::ptrdiff_t>(k); };
  switch (random_.below(6)) {
    case 0:
      return draw_insertion();
    case 1: {
      HistoryStroke stroke = draw_stroke();
      if (random_.one_in(2)) {  // one pose is moved
        stroke = list_[at].stroke;
        const std::size_t row = static_cast<std::size_t>(random_.bits() % stroke.poses.size());
        stroke.poses[row].tip += stage_.frame.pitch * random_.uniform(-3, 3) * random_.direction();
      }
      return {"replace", [=](History& h, const Progress& p) { h.replace(id, stroke, p); },
              [=](std::vector<Listed>& list) { list[at].stroke = stroke; }};
    }
    case 2:
      return {"remove", [=](History& h, const Progress& p) { h.remove(id, p); },
              [=](std::vector<Listed>& list) { list.erase(place(list, at)); }};
    case 3:
    case 4: {
      const bool last = random_.one_in(4);
      return {
          "move",
          [=](History& h, const Progress& p) { h.move(id, last ? std::nullopt : std::optional<StrokeId>(before), p); },
          [=](std::vector<Listed>& list) {
            const std::size_t to = last ? list.size() : other;
            Listed moved = list[at];
            list.insert(place(list, to), moved);
            list.erase(place(list, to <= at ? at + 1 : at));
          }};
    }
    default: {
      const bool enabled = random_.one_in(4) ? list_[at].enabled : !list_[at].enabled;
      return {"enable", [=](History& h, const Progress& p) { h.enable(id, enabled, p); },
              [=](std::vector<Listed>& list) { list[at].enabled = enabled; }};
    }
  }
}

Volume Session::replay() const {
  Volume out = *base_;
  for (const Listed& listed : list_) {
    if (!listed.enabled) continue;
    sweep::CarveOptions options;
    options.tolerance = listed.stroke.tolerance, options.mode = listed.stroke.mode;
    if (listed.stroke.protect) options.protect = &*listed.stroke.protect;
    sweep::carve(out, listed.stroke.tool, listed.stroke.poses, options);
  }
  return out;
}

/// Cancels an edit at any of its reports; the history must be unchanged.
std::string Session::problem_of_cancel(History& history, const Edit& edit) {
  const auto before = dexel::to_bytes(history.volume());
  const auto ids = history.ids();
  int left = random_.below(6);
  try {
    edit.of_history(history, [&](double) { return left-- > 0; });
  } catch (const Cancelled&) {
    ++out_.cancelled;
    if (dexel::to_bytes(history.volume()) != before) return "a cancelled edit changed the volume";
    if (history.ids() != ids) return "a cancelled edit changed the order";
    edit.of_history(history, {});
  }
  return {};
}

/// Makes the edit, perhaps after a cancelled attempt, and checks its result.
std::string Session::problem(History& history, const Edit& edit, const std::vector<std::uint8_t>& expected) {
  const Volume before = history.volume();
  if (random_.one_in(4)) {
    if (std::string text = problem_of_cancel(history, edit); !text.empty()) return text;
  } else {
    edit.of_history(history, {});
  }
  const Volume& now = history.volume();
  if (dexel::to_bytes(now) != expected) return "the volume differs from a replay";
  for (std::size_t g = 0; g < now.grids().size(); ++g)
    for (std::size_t t = 0; t < now.grids()[g].tile_count(); ++t) {
      const auto &a = before.grids()[g].shared_tile(t), &b = now.grids()[g].shared_tile(t);
      if (a != b && same_material(*a, *b)) return "a tile was replaced although its content is the same";
    }
  const auto ids = history.ids();
  if (!std::ranges::equal(ids, list_, {}, {}, &Listed::id)) return "the order differs from that of the list";
  return {};
}

bool Session::check(int number, const Edit& edit) {
  edit.of_list(list_);
  const std::vector<std::uint8_t> expected = dexel::to_bytes(replay());
  ++out_.edits;
  for (std::size_t k = 0; k < histories_.size(); ++k) {
    const ThreadCount threads(options_.threads[k]);
    const auto revision = histories_[k].volume().revision();
    const std::string text = problem(histories_[k], edit, expected);
    if (!text.empty()) {
      out_.failures.push_back(
          {options_.seed, number_, number, edit.name + " with " + options_.threads[k] + " threads: " + text});
      return false;
    }
    if (k > 0) continue;
    out_.unchanged += histories_[0].volume().revision() == revision;
    out_.tiles_run += static_cast<long>(histories_[0].stats().tiles_run);
    for (const Listed& listed : list_)
      for (const dexel::Grid& grid : base_->grids())
        out_.tiles_in_all += listed.enabled ? static_cast<long>(grid.tile_count()) : 0;
  }
  return true;
}

void Session::run() {
  base_.emplace(stage_.frame);
  base_ = draw_base();
  if (random_.one_in(2)) {
    mask_.emplace(stage_.frame);
    HistoryStroke s = draw_stroke();
    sweep::CarveOptions options;
    options.mode = sweep::CarveMode::Add;
    sweep::carve(*mask_, s.tool, s.poses, options);
  }
  const std::size_t limit = random_.one_of({std::size_t{0}, std::size_t{200'000}, History::kMemoryLimit});
  for (std::size_t k = 0; k < options_.threads.size(); ++k) histories_.emplace_back(*base_, limit);
  ++out_.sessions;
  const int first = 2 + random_.below(10);
  for (int k = 0; k < first + kEditsInSession; ++k)
    if (!check(k, k < first ? draw_insertion() : draw_edit())) return;
  for (int k = first + kEditsInSession; !list_.empty(); ++k) {
    const StrokeId id = list_[any()].id;
    if (!check(k, {"remove all", [=](History& h, const Progress& p) { h.remove(id, p); },
                   [=](std::vector<Listed>& list) { std::erase_if(list, [=](auto& l) { return l.id == id; }); }}))
      return;
  }
}

}  // namespace

void run_history_session(const HistoryOptions& options, std::uint64_t session, HistoryResults& out) {
  Session(options, session, out).run();
}

HistoryResults run_histories(const HistoryOptions& options, long edits,
                             const std::function<bool(const HistoryResults&)>& progress) {
  HistoryResults out;
  for (std::uint64_t session = 0; out.edits < edits; ++session) {
    run_history_session(options, session, out);
    if (progress && !progress(out)) break;
  }
  return out;
}

std::string reproducer(const HistoryFailure& failure) {
  return "riffler_history_stress --seed " + std::to_string(failure.seed) + " --session " +
         std::to_string(failure.session);
}

}  // namespace riffler::stress
