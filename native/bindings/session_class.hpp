// The class of riffler.Session, for the files that bind its topics.
#pragma once

#include <memory>
#include <optional>

#include "bindings/one_caller.hpp"
#include "bindings/program_types.hpp"
#include "bindings/shared_volume.hpp"
#include "riffler/session/journal_sink.hpp"
#include "riffler/session/session.hpp"

namespace riffler::bindings {

using Obstacles = std::shared_ptr<collide::Collider>;

/// A session with what it uses, which Python may have let go.
struct SharedSession : Guarded {
  std::shared_ptr<SharedVolume> volume;
  std::shared_ptr<pen::Pen> pen;
  Tool tool;
  sweep::MoveCarver::Options carving;
  sweep::CarveMode mode;
  std::optional<Volume> mask{};
  std::shared_ptr<session::JournalSink> sink;
  std::unique_ptr<session::Session> session;
  session::SculptTick last{};

  SharedSession(std::shared_ptr<SharedVolume> v, std::shared_ptr<pen::Pen> p, const Tool& t,
                const session::SessionSettings& settings)
      : volume(std::move(v)), pen(std::move(p)), tool(t), carving(settings.loop.carving), mode(settings.mode) {}
  ~SharedSession() {
    const NoGil release;  // the thread of the device may be waiting for it
    session.reset();
    if (sink) sink->close();
  }
};

/// One call at a time, and the volume is the session's meanwhile.
struct Using {
  explicit Using(SharedSession& s) : only(s, "the session"), writing(*s.volume), volume(writing.volume) {}
  OneCaller only;
  Writing writing;
  Volume& volume;
};

/// None: no rotation. ValueError for other shapes than (3, 3).
Mat3 to_turn(const OptionalArrayLike& turn);

/// Set where the device decides: 0.4 ms a step for a device with motors, none for others.
inline constexpr const char* kAutomaticBudget = "auto";
/// s for a step. TypeError for anything but a number, None or "auto".
std::optional<double> to_budget(const BudgetLike& budget, const pen::Pen& pen);

/// The class with its constructor.
py::class_<SharedSession> bind_session_class(py::module_& m);

}  // namespace riffler::bindings
