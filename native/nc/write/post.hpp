// What the controls read: one language per file, made of the same events. The writer says what happens, a post how it
// is written.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nc/machine/machine.hpp"
#include "nc/machine/post_options.hpp"

namespace riffler {

class Tool;

/// One block.
struct PostBlock {
  Pose pose;
  Joints joints{};
  bool rapid = false;
  bool inverse = false;  ///< takes `minutes`, whatever way its words go
  double feed = 0;       ///< mm/min at the tip; of rapids nothing
  double minutes = 0;
  bool must = false;  ///< a row ends here: written even where nothing moves
};

/// An arc in a plane of two linear axes, or a helix on it.
struct PostArc {
  PostBlock end;
  std::size_t normal = 2;  ///< axis across its plane: 2 for XY (G17), 1 for ZX (G18), 0 for YZ (G19)
  Vec3 from{0}, centre{0};
  bool clockwise = false;  ///< seen from the positive end of that axis
};

class Post {
 public:
  Post(const Machine& machine, PostOptions options) : machine_(machine), options_(std::move(options)) {}
  virtual ~Post() = default;

  /// Whether blocks need joints: where not, poses are written as they are.
  virtual bool wants_joints() const { return true; }

  virtual bool has_arcs() const { return false; }

  virtual void begin(std::span<const std::string> comments) = 0;
  /// `shape` is null where it is not known.
  virtual void change_tool(int number, const Tool* shape, bool first) = 0;
  /// rev/min; > 0 clockwise, 0 stopped.
  virtual void spindle(double speed) = 0;
  /// After a change, when tool and spindle stand as they should.
  virtual void ready(int tool) = 0;
  virtual void block(const PostBlock& block) = 0;
  /// Called only where has_arcs().
  virtual void arc(const PostArc&) {}
  virtual void end() = 0;

  const std::string& text() const { return text_; }
  std::size_t blocks() const { return blocks_; }

 protected:
  /// Whether tools come from where they are out of everything's way: the machine's file, or its user, says how.
  bool comes_safely() const { return options_.safe_start && (options_.retract || !machine_.control().retract.empty()); }

  const Machine& machine_;
  PostOptions options_;
  std::string text_;
  std::size_t blocks_ = 0;  ///< with a motion
};

/// std::invalid_argument for a machine whose language is not known.
std::unique_ptr<Post> make_post(const Machine& machine, PostOptions options);

// The factories, each in its own file. A new one is one line in posts.cpp and one in kLanguages.
std::unique_ptr<Post> make_rs274(const Machine& machine, PostOptions options);
std::unique_ptr<Post> make_heidenhain(const Machine& machine, PostOptions options);
std::unique_ptr<Post> make_sinumerik(const Machine& machine, PostOptions options);
std::unique_ptr<Post> make_apt(const Machine& machine, PostOptions options);

}  // namespace riffler
