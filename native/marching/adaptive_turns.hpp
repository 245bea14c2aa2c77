// One update of the groups of a layer, turn by turn.
#pragma once

#include "marching/adaptive_state.hpp"

namespace riffler::marching {

class AdaptiveState::Turns {
 public:
  /// `changed`: bricks whose full mesh changed; `owners`: bricks whose fixed vertices changed.
  Turns(const AdaptiveState& state, std::size_t layer, const std::vector<std::size_t>& changed,
        const std::vector<std::size_t>& owners);
  /// Brings all results of the layer up to date. Returns the bricks with another result of group 0.
  std::vector<std::size_t> run(Layer& layer, const Progress& progress);

 private:
  enum Mark : std::uint8_t {
    kChanged = 1,    // the full mesh
    kTouched = 2,    // its triangles at this turn
    kOwner = 4,      // its fixed vertices
    kCandidate = 8,  // its groups may have to be done again
  };

  void touch(std::size_t brick, std::uint8_t mark);
  bool is_due(const Vec3i& at, int group, const GroupResult* old) const;
  std::vector<std::size_t> due(Layer& layer, int group);
  void prepare(const Layer& layer, const std::vector<std::size_t>& tasks, std::size_t turn);
  void advance(const Layer& layer, std::size_t brick, std::size_t turn);
  Result result(const Layer& layer, std::size_t brick, int group, GroupInput& input,
                mesh::StarCollapser& collapser) const;
  bool gather_border(const Vec3i& at, int group, GroupInput& input) const;
  bool gather_inside(std::size_t brick, GroupInput& input) const;
  void gather_plain(std::size_t brick, GroupInput& input) const;
  void mark_movable(const Layer& layer, std::size_t brick, int group, GroupInput& input) const;
  void keep(std::size_t brick, int group, const Result& old, const Result& now);

  template <class Body>
  void at_sides(const Vec3i& at, int group, Body&& body) const {
    for (int side = 0; side < 8; ++side) {
      const Vec3i other = at + offset_of(side);
      if (reaches(group, side) && bricks_.has(other.x, other.y, other.z))
        body(side, bricks_.index(other.x, other.y, other.z));
    }
  }

  const AdaptiveState& state_;
  const Bricks& bricks_;
  const Layer* before_;  // the layer before this one
  std::vector<std::uint8_t> marks_;
  std::vector<std::size_t> candidates_;
  std::vector<std::unique_ptr<BorderState>> borders_;
  std::vector<std::size_t> renewed_;
};

}  // namespace riffler::marching
