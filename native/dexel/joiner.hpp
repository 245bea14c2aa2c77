// Joins ends along a ray into spans.
#pragma once

#include "riffler/dexel/tile.hpp"

namespace riffler::dexel {

/// Spans and gaps thinner than this fraction of the pitch vanish.
inline constexpr double kSliver = 1e-9;

/// Converts the ends of one ray to spans: first closes narrow gaps, then drops thin spans.
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
