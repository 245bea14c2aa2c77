// The yardstick: B200 on a plain height map, one thread. No dexels, no spans, no tool but the ball: what any engine has
// to do at least. Times are quoted as ratios to this loop in the same run, since machines differ and are shared.
#pragma once

#include <vector>

namespace riffler::bench {

class CapsuleLoop {
 public:
  /// Height map of B200's block; `pitch` in mm.
  explicit CapsuleLoop(double pitch);
  /// The block as it was, not part of what is timed.
  void reset();
  /// Takes the 200 capsules away.
  void run();
  /// mm³ gone since the reset.
  double removed() const;
  const std::vector<double>& heights() const { return top_; }

 private:
  double h_;
  int nx_, ny_;
  std::vector<double> top_;
};

}  // namespace riffler::bench
