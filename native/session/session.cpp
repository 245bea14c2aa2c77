#include "riffler/session/session.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/own_thread.hpp"
#include "riffler/base/block_pool.hpp"
#include "session/masked_stock.hpp"
#include "session/step_thread.hpp"

namespace riffler::session {

namespace {

// Memory for a tile of three directions with many spans, and the number of tiles that the steps of one frame may cut
// for the first time.
constexpr std::size_t kLargestBlock = 1 << 17, kBlocks = 64;

/// Adding material meets no resistance: a force would be that of milling air.
SculptLoopSettings for_mode(SculptLoopSettings settings, sweep::CarveMode mode) {
  if (mode == sweep::CarveMode::Add) settings.carving.removal_constant = settings.sculpt.damping = 0;
  return settings;
}

}  // namespace

void SessionSettings::validate() const {
  loop.validate();
  if (loop.touch && mode == sweep::CarveMode::Add)
    throw std::invalid_argument("touch: a session that adds material feels none of it: leave touch off");
  if (start && !(geom::finite(start->tip) && std::abs(glm::length(start->axis) - 1) < 1e-6))
    throw std::invalid_argument("start must be a finite point and an axis of unit length");
}

/// Both sides of a session: the loop that cuts, and the display.
struct Session::Core {
  Core(const Volume& stock, const Tool& tool, std::shared_ptr<pen::Pen> pen,
       std::shared_ptr<const collide::Collider> obstacles, const SessionSettings& settings, const Volume* protect);
  ~Core();

  void record(std::shared_ptr<StrokeSink> sink);
  void start();
  SessionFrame stop(Volume& shown);
  SessionFrame frame(Volume& shown);
  std::size_t undo(Volume& shown);
  std::size_t redo(Volume& shown);

  enum class State : unsigned char { New, Running, Ended };
  /// The volume between two strokes.
  struct Moment {
    std::uint64_t strokes;  // strokes since the previous moment: one, or more if frames were rare
    Volume volume;
    std::optional<Volume> left{};  // remainder of the cuttable volume, unless that is `volume` itself

    const Volume& cut() const { return left ? *left : volume; }  // the volume that the loop cuts
  };

  std::optional<Pose> start_pose() const;
  TileExchange::Mark follow(Volume& shown, std::vector<TileExchange::Place>& places);
  void take_ticks(SessionFrame& frame);
  void look(Volume& shown, SessionFrame& frame);
  std::size_t go_to(Volume& shown, int step, const char* what);
  void note_differences(const Volume& from, const Volume& to);

  SessionSettings settings_;
  Tool tool_;
  std::shared_ptr<pen::Pen> pen_;
  std::shared_ptr<const collide::Collider> obstacles_;
  std::shared_ptr<StrokeSink> sink_;
  std::shared_ptr<SculptLoop> loop_;
  State state_ = State::New;
  StepThread ticks_;
  base::HomeProcess home_;
  base::BlockReserve reserve_;

  std::optional<MaskedStock> masked_stock_;  // unless the loop cuts the stock itself
  std::optional<Volume> left_;               // its remainder as displayed
  std::uint64_t shown_ = 0;                  // revision of the displayed volume
  std::vector<Moment> moments_;              // states between strokes; oldest first
  std::size_t here_ = 0;                     // index of the moment displayed or being changed
  std::uint64_t strokes_ = 0;                // strokes seen
  SessionFrame kept_;                        // for the next frame
};

Session::Core::Core(const Volume& stock, const Tool& tool, std::shared_ptr<pen::Pen> pen,
                    std::shared_ptr<const collide::Collider> obstacles, const SessionSettings& settings,
                    const Volume* protect)
    : settings_((settings.validate(), settings)),
      tool_(tool),
      pen_(std::move(pen)),
      obstacles_(std::move(obstacles)),
      shown_(stock.revision()) {
  if (!pen_) throw std::invalid_argument("a session needs a device");
  settings_.loop = for_mode(settings_.loop, settings.mode);
  settings_.loop.safety = for_device(settings_.loop.safety, pen_->capability());
  if (protect || settings.mode == sweep::CarveMode::Add)
    left_ = masked_stock_.emplace(stock, settings.mode, protect).volume();
  moments_.push_back({0, stock, left_});
}

Session::Core::~Core() {
  if (!home_.here()) {  // after a fork, the missing thread may hold the locks
    static_cast<void>(new std::shared_ptr<SculptLoop>(std::move(loop_)));
    static_cast<void>(new std::shared_ptr<pen::Pen>(std::move(pen_)));
    return;
  }
  Volume nobody = moments_[here_].volume;
  shown_ = nobody.revision();
  stop(nobody);
}

void Session::Core::record(std::shared_ptr<StrokeSink> sink) {
  if (state_ != State::New) throw std::runtime_error("the session has started: its earlier strokes would be missing");
  sink_ = std::move(sink);
}

/// Pose of the tool at the start.
std::optional<Pose> Session::Core::start_pose() const {
  if (settings_.start || pen_->in_part_frame()) return settings_.start;
  const Box3& box = moments_[0].volume.frame().box;
  return Pose{{0.5 * (box.lower.x + box.upper.x), 0.5 * (box.lower.y + box.upper.y), box.upper.z + 5}, {0, 0, 1}};
}

void Session::Core::start() {
  if (state_ != State::New) throw std::runtime_error("a session runs once: make another");
  loop_ = std::make_shared<SculptLoop>(settings_.loop, moments_[0].cut(), tool_, obstacles_.get(), pen_->capability(),
                                       start_pose(), sink_.get());
  reserve_.fill(kLargestBlock, kBlocks);
  ticks_.start(*pen_, loop_);
  state_ = State::Running;
}

SessionFrame Session::Core::stop(Volume& shown) {
  if (state_ != State::Running) return std::exchange(kept_, {});
  home_.check("the session");
  SessionFrame frame = std::exchange(kept_, {});
  ticks_.stop(*pen_, *loop_, settings_.loop.safety.fall);
  loop_->finish();
  state_ = State::Ended;
  try {
    look(shown, frame);
  } catch (...) {
    take_ticks(frame);
    kept_ = std::move(frame);
    throw;
  }
  return frame;
}

SessionFrame Session::Core::frame(Volume& shown) {
  if (state_ != State::Running) throw std::runtime_error("the session is not running");
  home_.check("the session");
  SessionFrame frame = std::exchange(kept_, {});
  look(shown, frame);
  std::ranges::sort(frame.tiles, {}, [](const TileExchange::Place& p) { return std::pair(p.grid, p.tile); });
  const auto twice = std::ranges::unique(frame.tiles);
  frame.tiles.erase(twice.begin(), twice.end());
  reserve_.fill(kLargestBlock, kBlocks);
  return frame;
}

/// Brings what the loop has cut since into `shown`.
TileExchange::Mark Session::Core::follow(Volume& shown, std::vector<TileExchange::Place>& places) {
  if (!masked_stock_) return loop_->show(shown, places);
  const std::size_t before = places.size();
  const TileExchange::Mark mark = loop_->show(*left_, places);
  masked_stock_->show(*left_, std::span(places).subspan(before), shown);
  return mark;
}

void Session::Core::take_ticks(SessionFrame& frame) {
  for (SculptTick tick; loop_->take(tick);) frame.ticks.push_back(tick);
  frame.strokes = strokes_, frame.dropped_ticks = loop_->dropped_ticks();
}

void Session::Core::look(Volume& shown, SessionFrame& frame) {
  if (shown.revision() != shown_)
    throw std::runtime_error(
        "the volume was changed by something else while the session ran: what was cut since the last frame is not in "
        "it. Stop the session before you change its volume");
  const TileExchange::Mark mark = follow(shown, frame.tiles);
  shown_ = shown.revision();
  take_ticks(frame);
  frame.strokes = mark.strokes, frame.in_stroke = mark.in_stroke;
  if (mark.in_stroke || mark.strokes == strokes_) return;
  moments_.erase(moments_.begin() + static_cast<std::ptrdiff_t>(here_) + 1, moments_.end());  // ends redo
  moments_.push_back({mark.strokes - std::exchange(strokes_, mark.strokes), shown, left_});
  if (moments_.size() > settings_.undo + 1) moments_.erase(moments_.begin());
  here_ = moments_.size() - 1;
}

std::size_t Session::Core::undo(Volume& shown) {
  return go_to(shown, -1, "undone");
}

std::size_t Session::Core::redo(Volume& shown) {
  return go_to(shown, 1, "redone");
}

/// Moves one moment forward or back.
std::size_t Session::Core::go_to(Volume& shown, int step, const char* what) {
  SessionFrame frame;
  if (state_ != State::Running) throw std::runtime_error("the session is not running");
  home_.check("the session");
  look(shown, frame);
  if (frame.in_stroke) throw std::runtime_error(std::string("nothing can be ") + what + " in the middle of a stroke");
  std::copy(frame.ticks.begin(), frame.ticks.end(), std::back_inserter(kept_.ticks));
  std::copy(frame.tiles.begin(), frame.tiles.end(), std::back_inserter(kept_.tiles));
  if (step < 0 ? here_ == 0 : here_ + 1 == moments_.size()) return 0;
  const std::size_t next = step < 0 ? here_ - 1 : here_ + 1;
  const std::uint64_t strokes = moments_[std::max(here_, next)].strokes;
  if (!loop_->replace(moments_[next].cut(), step * static_cast<std::int64_t>(strokes)))
    throw std::runtime_error(std::string("nothing can be ") + what + " in the middle of a stroke");
  note_differences(shown, moments_[next].volume);
  shown.restore(moments_[next].volume);
  left_ = moments_[next].left;
  shown_ = shown.revision(), here_ = next;
  return strokes;
}

/// Reports the tiles in which the two volumes differ with the next frame.
void Session::Core::note_differences(const Volume& from, const Volume& to) {
  for (std::uint32_t g = 0; g < from.grids().size(); ++g)
    for (std::size_t t = 0; t < from.grids()[g].tile_count(); ++t)
      if (from.grids()[g].shared_tile(t) != to.grids()[g].shared_tile(t))
        kept_.tiles.push_back({g, static_cast<std::uint32_t>(t)});
}

Session::Session(const Volume& stock, const Tool& tool, std::shared_ptr<pen::Pen> pen,
                 std::shared_ptr<const collide::Collider> obstacles, const SessionSettings& settings,
                 const Volume* protect)
    : core_(std::make_unique<Core>(stock, tool, std::move(pen), std::move(obstacles), settings, protect)) {}

Session::~Session() = default;

void Session::record(std::shared_ptr<StrokeSink> sink) {
  core_->record(std::move(sink));
}

void Session::start() {
  core_->start();
}

bool Session::running() const noexcept {
  return core_->state_ == Core::State::Running;
}

base::ThreadPriority Session::priority() const {
  return core_->ticks_.priority(*core_->pen_);
}

SessionFrame Session::stop(Volume& shown) {
  return core_->stop(shown);
}

SessionFrame Session::frame(Volume& shown) {
  return core_->frame(shown);
}

std::size_t Session::undo(Volume& shown) {
  return core_->undo(shown);
}

std::size_t Session::redo(Volume& shown) {
  return core_->redo(shown);
}

SculptLoop* Session::loop() noexcept {
  return core_->loop_.get();
}

pen::Pen& Session::pen() noexcept {
  return *core_->pen_;
}

}  // namespace riffler::session
