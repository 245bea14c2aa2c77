// How ends along a ray become spans again.
#pragma once

#include "riffler/dexel/tile.hpp"

namespace riffler::dexel {

/// Spans and gaps thinner than this part of the pitch vanish.
inline constexpr double kSliver = 1e-9;

/// Hands the ends of one ray on as spans: first joins over gaps, then drops slivers.
class Joiner {
 public:
  Joiner(TileBuilder& out, double least) : out_(out), least_(least) {}

  void open(double x, const PackedNormal& normal) {
    if (pending_ && x - span_.far < least_) return;
    flush();
    span_.near = x, normals_.near = normal, pending_ = true;
  }
  void close(double x, const PackedNormal& normal) { span_.far = x, normals_.far = normal; }
  void flush() {
    if (pending_ && span_.length() >= least_) out_.add(span_, normals_);
    pending_ = false;
  }

 private:
  TileBuilder& out_;
  double least_;
  bool pending_ = false;
  Span span_{};
  SpanNormals normals_;
};

}  // namespace riffler::dexel
