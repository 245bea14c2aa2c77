// NC code in the languages of the controls, one per file. A post writes the blocks of a program
// (nc/write/block_maker.hpp).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nc/machine/post_options.hpp"
#include "nc/write/block_sink.hpp"

namespace riffler::nc {

class Post : public BlockSink {
 public:
  Post(const Machine& machine, PostOptions options) : machine_(machine), options_(std::move(options)) {}

  /// Whether blocks need joints; otherwise poses are written unchanged.
  virtual bool wants_joints() const { return true; }

  virtual bool has_arcs() const { return false; }

  /// Called only if has_arcs().
  void arc(const PostArc&) override {}

  /// The text before the first block and after the last one.
  virtual void begin(std::span<const std::string> comments) = 0;
  virtual void end() = 0;

  const std::string& text() const { return text_; }
  std::size_t blocks() const { return blocks_; }

 protected:
  /// Whether tools start from a retracted position, defined by the machine's file or the user's option.
  bool comes_safely() const { return options_.safe_start && (options_.retract || !machine_.control().retract.empty()); }

  const Machine& machine_;
  PostOptions options_;
  std::string text_;
  std::size_t blocks_ = 0;  ///< blocks with a motion
};

/// Throws std::invalid_argument for a machine with an unknown language.
std::unique_ptr<Post> make_post(const Machine& machine, PostOptions options);

#define RIFFLER_DECLARE_POST(name, extension) \
  std::unique_ptr<Post> make_##name(const Machine& machine, PostOptions options);
RIFFLER_LANGUAGES(RIFFLER_DECLARE_POST)
#undef RIFFLER_DECLARE_POST

}  // namespace riffler::nc
