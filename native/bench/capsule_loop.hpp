// The yardstick of the bench: B200 on a plain height map in one thread, without dexels or spans, for a ball only. Every
// engine has to do at least this work. Times are quoted as ratios to this loop in the same run, because machines differ
// and are shared.
#pragma once

#include <vector>

namespace riffler::bench {

class CapsuleLoop {
 public:
  /// Height map of B200's block; `pitch` in mm.
  explicit CapsuleLoop(double pitch);
  /// Restores the whole block. Not timed.
  void reset();
  /// Removes the 200 capsules.
  void run();
  /// Volume removed since the reset, mm³.
  double removed() const;
  const std::vector<double>& heights() const { return top_; }

 private:
  double h_;
  int nx_, ny_;
  std::vector<double> top_;
};

}  // namespace riffler::bench
