#include "session/replay.hpp"

#include <stdexcept>
#include <string>

#include "dexel/file.hpp"
#include "sweep/carve.hpp"

namespace riffler {

namespace {

/// The volume as the session found it.
Volume stock_of(const Journal& journal, const std::filesystem::path& folder, const Progress& progress) {
  if (!journal.stock()) throw std::invalid_argument("the journal has no stock to replay on");
  const JournalStock& stock = *journal.stock();
  const Frame frame{stock.box, stock.pitch, stock.directions};
  if (stock.snapshot.empty()) return Volume::block(frame);
  // A journal from somebody else must not reach for other files than those beside it.
  const std::filesystem::path name = stock.snapshot;
  if (name != name.filename() || name == "." || name == "..")
    throw std::invalid_argument("the stock's snapshot must be a file's name, not \"" + stock.snapshot + "\"");
  if (folder.empty()) throw std::invalid_argument("the stock is the snapshot " + stock.snapshot + ": name its folder");
  Volume volume = load(folder / name, progress);
  if (!(volume.frame() == frame))
    throw std::invalid_argument("the snapshot " + stock.snapshot + " has another frame than the journal's stock");
  return volume;
}

}  // namespace

std::vector<Pose> moves_of(const JournalStroke& stroke) {
  std::vector<Pose> out;
  for (const Pose& pose : stroke.poses)
    if (out.empty() || !stands(out.back(), pose)) out.push_back(pose);
  if (out.size() == 1 && stroke.poses.size() > 1) out.push_back(out[0]);
  return out;
}

Volume replay(const Journal& journal, const std::map<int, Tool>& tools, const std::filesystem::path& folder,
              const Progress& progress) {
  constexpr double kStock = 0.05;  // share of the work, for the listener
  Volume volume = stock_of(journal, folder, part(progress, 0, kStock));
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
    CarveOptions options;
    options.tolerance = stroke.tolerance;
    options.progress = part(progress, begin, share());
    try {
      carve(volume, tool->second, moves_of(stroke), options);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(name + ": " + e.what());
    }
    report(progress, share());
  }
  report(progress, 1);
  return volume;
}

}  // namespace riffler
