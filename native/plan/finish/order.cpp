#include "plan/finish/order.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geom/math.hpp"

namespace riffler::plan {

namespace {

constexpr std::size_t kLooks = 400;  // number of pieces examined on either side of the last one, by rank

/// Linked lists of unvisited pieces: the next one before and after each piece.
class Remaining {
 public:
  explicit Remaining(std::size_t n) : next_(n + 2), before_(n + 2) {
    for (std::size_t k = 0; k < n + 2; ++k) next_[k] = k + 1, before_[k] = k ? k - 1 : 0;
  }
  void remove(std::size_t k) { next_[before_[k]] = next_[k], before_[next_[k]] = before_[k]; }
  std::size_t next(std::size_t k) const { return next_[k]; }
  std::size_t before(std::size_t k) const { return before_[k]; }

 private:
  std::vector<std::size_t> next_, before_;  // 1 … n are pieces; 0 and n + 1 are ends
};

double squared(const Vec3& a, const Vec3& b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}

}  // namespace

std::vector<CutPiece> in_short_order(std::vector<CutPiece> pieces) {
  std::stable_sort(pieces.begin(), pieces.end(), [](const CutPiece& a, const CutPiece& b) { return a.rank < b.rank; });
  const std::size_t n = pieces.size();
  std::vector<CutPiece> out;
  out.reserve(n);
  Remaining left(n);
  std::size_t last = 1;
  for (std::size_t done = 0; done < n; ++done) {
    std::size_t best = 0;
    bool turned = false;
    double least = kInfinity;
    const auto look = [&](std::size_t k) {
      const CutPiece& piece = pieces[k - 1];
      for (const bool back : {false, true}) {
        const double d = squared(out.back().tips.back(), back ? piece.tips.back() : piece.tips.front());
        if (d < least) least = d, best = k, turned = back;
      }
    };
    if (done == 0) {
      best = 1;
    } else {
      std::size_t k = left.before(last);
      for (std::size_t looks = 0; k > 0 && looks < kLooks; ++looks, k = left.before(k)) look(k);
      k = left.next(last);
      for (std::size_t looks = 0; k <= n && looks < kLooks; ++looks, k = left.next(k)) look(k);
    }
    out.push_back(pieces[best - 1]);
    if (turned) std::reverse(out.back().tips.begin(), out.back().tips.end());
    left.remove(best);
    last = best;
  }
  return out;
}

namespace {

/// Index of the tip nearest to `p`, and the squared distance between them seen along the axis.
std::pair<std::size_t, double> nearest_tip(const std::vector<Vec3>& tips, const Vec3& p) {
  std::pair<std::size_t, double> out{0, kInfinity};
  for (std::size_t k = 0; k < tips.size(); ++k)
    if (const double d = squared(tips[k], p); d < out.second) out = {k, d};
  return out;
}

void begin_at(std::vector<Vec3>& ring, std::size_t k) {
  if (k == 0) return;
  ring.pop_back();
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(k % ring.size()), ring.end());
  ring.push_back(ring.front());
}

/// Pieces of one wall, from its top downwards.
struct Chain {
  std::vector<CutPiece> pieces;
  Box3 last;  // box of the last piece
};

}  // namespace

std::vector<CutPiece> descending(std::vector<CutPiece> pieces, double near) {
  std::stable_sort(pieces.begin(), pieces.end(), [](const CutPiece& a, const CutPiece& b) { return a.rank < b.rank; });
  std::vector<Chain> chains;
  for (CutPiece& piece : pieces) {
    const Vec3 first = piece.tips.front();
    Chain* best = nullptr;
    double least = near * near;
    for (Chain& chain : chains) {
      const CutPiece& above = chain.pieces.back();
      if (above.rank == piece.rank || first.x < chain.last.lower.x - near || first.x > chain.last.upper.x + near ||
          first.y < chain.last.lower.y - near || first.y > chain.last.upper.y + near)
        continue;
      if (const double d = nearest_tip(above.tips, first).second; d < least) least = d, best = &chain;
    }
    if (!best) best = &chains.emplace_back();
    if (piece.closed && !best->pieces.empty())
      begin_at(piece.tips, nearest_tip(piece.tips, best->pieces.back().tips.back()).first);
    best->last = {};
    for (const Vec3& p : piece.tips) best->last.add(p);
    best->pieces.push_back(std::move(piece));
  }
  std::vector<CutPiece> out;
  out.reserve(pieces.size());
  for (Chain& chain : chains)
    for (CutPiece& piece : chain.pieces) out.push_back(std::move(piece));
  return out;
}

}  // namespace riffler::plan
