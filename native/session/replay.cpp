#include "riffler/session/replay.hpp"

#include <stdexcept>
#include <string>

#include "riffler/brush/brush_dabs.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/dexel/smooth/smooth_dabs.hpp"
#include "riffler/sweep/carve.hpp"
#include "session/masked_stock.hpp"

namespace riffler::session {

namespace {

/// A foreign journal must not access files outside its own folder.
Volume snapshot_of(const std::string& file, const char* what, const dexel::Frame& frame,
                   const std::filesystem::path& folder, const Progress& progress) {
  const std::filesystem::path name = file;
  if (name != name.filename() || name == "." || name == "..")
    throw std::invalid_argument(std::string(what) + "'s snapshot must be a file's name, not \"" + file + "\"");
  if (folder.empty()) throw std::invalid_argument(std::string(what) + " is the snapshot " + file + ": name its folder");
  Volume volume = dexel::load(folder / name, progress);
  if (!(volume.frame() == frame))
    throw std::invalid_argument("the snapshot " + file + " has another frame than the journal's stock");
  return volume;
}

/// Stock and mask at the start of the session.
Replayed begin(const Journal& journal, const std::filesystem::path& folder, const Progress& progress) {
  if (!journal.stock()) throw std::invalid_argument("the journal has no stock to replay on");
  const JournalStock& stock = *journal.stock();
  const dexel::Frame frame{stock.box, stock.pitch, stock.directions};
  Replayed out{
      stock.snapshot.empty() ? Volume::block(frame) : snapshot_of(stock.snapshot, "the stock", frame, folder, progress),
      {}};
  if (!stock.mask.empty()) out.mask = snapshot_of(stock.mask, "the mask", frame, folder, {});
  return out;
}

void apply_dabs(const JournalStroke& stroke, const Tool& tool, Replayed& to, const Progress& progress) {
  std::vector<Vec3> centres;
  for (const Pose& pose : stroke.poses) centres.push_back(pose.tip);
  dexel::SmoothOptions options;
  options.radius = 0.5 * tool.diameter();
  options.strength = stroke.strength;
  options.protect = to.mask ? &*to.mask : nullptr;
  options.progress = progress;
  smooth_dabs(to.volume, centres, options);
}

void apply_brush(const JournalStroke& stroke, const Tool& tool, Replayed& to, const Progress& progress) {
  brush::BrushOptions options;
  options.kind = brush_of(stroke.mode);
  options.radius = 0.5 * tool.diameter();
  options.strength = stroke.strength;
  options.amount = stroke.amount;
  options.falloff = stroke.falloff;
  options.protect = to.mask ? &*to.mask : nullptr;
  options.progress = progress;
  brush_dabs(to.volume, stroke.poses, options);
}

void carve_stroke(Volume& volume, const Tool& tool, const JournalStroke& stroke, const sweep::CarveOptions& options) {
  if (stroke.forward.empty())
    sweep::carve(volume, tool, moves_of(stroke), options);
  else
    sweep::carve(volume, tool, rolled_moves_of(stroke), options);
}

/// A run of session strokes that cut a derived volume rather than the stock itself: all of one mode.
struct Run {
  MaskedStock cuttable;
  Volume left;
};

/// How such a stroke carves, or no value for strokes that carve the volume itself. Without a mask everything may be
/// cut.
std::optional<sweep::CarveMode> run_mode(const JournalStroke& stroke, const Replayed& to) {
  if (stroke.mode == StrokeMode::Build) return sweep::CarveMode::Add;
  if (stroke.mode == StrokeMode::Beside && to.mask) return sweep::CarveMode::Remove;
  return std::nullopt;
}

void apply_in_run(const JournalStroke& stroke, sweep::CarveMode mode, const Tool& tool, const Replayed& to,
                  std::optional<Run>& run, const Progress& progress) {
  if (!run) {
    const MaskedStock cuttable(to.volume, mode, to.mask ? &*to.mask : nullptr);
    run.emplace(Run{cuttable, cuttable.volume()});
  }
  sweep::CarveOptions options;
  options.tolerance = stroke.tolerance;
  options.progress = progress;
  carve_stroke(run->left, tool, stroke, options);
}

/// Sets the volume to the result of those strokes.
void end_run(Replayed& to, std::optional<Run>& run) {
  if (run) to.volume = run->cuttable.whole(run->left);
  run.reset();
}

void apply(const JournalStroke& stroke, const Tool& tool, Replayed& to, std::optional<Run>& run,
           const Progress& progress) {
  const std::optional<sweep::CarveMode> mode = run_mode(stroke, to);
  if (run && mode != run->cuttable.mode()) end_run(to, run);
  if (mode) return apply_in_run(stroke, *mode, tool, to, run, progress);
  if (stroke.mode == StrokeMode::Soften) return apply_dabs(stroke, tool, to, progress);
  if (is_brush(stroke.mode)) return apply_brush(stroke, tool, to, progress);
  sweep::CarveOptions options;
  options.tolerance = stroke.tolerance;
  options.progress = progress;
  const bool masks = stroke.mode == StrokeMode::Mask || stroke.mode == StrokeMode::Unmask;
  if (masks && !to.mask) to.mask.emplace(to.volume.frame());
  if (stroke.mode == StrokeMode::Add || stroke.mode == StrokeMode::Mask) options.mode = sweep::CarveMode::Add;
  if (!masks && to.mask) options.protect = &*to.mask;
  carve_stroke(masks ? *to.mask : to.volume, tool, stroke, options);
}

}  // namespace

std::vector<Pose> moves_of(const JournalStroke& stroke) {
  std::vector<Pose> out;
  for (const Pose& pose : stroke.poses)
    if (out.empty() || !stands(out.back(), pose)) out.push_back(pose);
  if (out.size() == 1 && stroke.poses.size() > 1) out.push_back(out[0]);
  return out;
}

std::vector<RolledPose> rolled_moves_of(const JournalStroke& stroke) {
  std::vector<RolledPose> out;
  for (std::size_t row = 0; row < stroke.forward.size(); ++row) {
    const RolledPose pose{stroke.poses[row].tip, stroke.poses[row].axis, stroke.forward[row]};
    const bool moved = out.empty() || out.back().tip != pose.tip || out.back().axis != pose.axis;
    if (moved || out.back().forward != pose.forward) out.push_back(pose);
  }
  if (out.size() == 1 && stroke.forward.size() > 1) out.push_back(out[0]);
  return out;
}

Replayed replay_all(const Journal& journal, const std::map<int, Tool>& tools, const std::filesystem::path& folder,
                    const Progress& progress) {
  constexpr double kStock = 0.05;  // fraction of the work, for progress
  Replayed out = begin(journal, folder, base::part(progress, 0, kStock));
  std::optional<Run> run;
  double rows = 0, done = 0;
  for (const JournalStroke& stroke : journal.strokes()) rows += static_cast<double>(stroke.poses.size());
  const auto share = [&] { return rows > 0 ? kStock + (1 - kStock) * done / rows : 1; };
  for (std::size_t k = 0; k < journal.strokes().size(); ++k) {
    const JournalStroke& stroke = journal.strokes()[k];
    const std::string name = "stroke " + std::to_string(k);
    const auto tool = tools.find(stroke.tool);
    if (tool == tools.end()) throw std::invalid_argument(name + ": there is no tool " + std::to_string(stroke.tool));
    const double begin = share();
    done += static_cast<double>(stroke.poses.size());
    try {
      apply(stroke, tool->second, out, run, base::part(progress, begin, share()));
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(name + ": " + e.what());
    }
    base::report(progress, share());
  }
  end_run(out, run);
  base::report(progress, 1);
  return out;
}

Volume replay(const Journal& journal, const std::map<int, Tool>& tools, const std::filesystem::path& folder,
              const Progress& progress) {
  return replay_all(journal, tools, folder, progress).volume;
}

}  // namespace riffler::session
