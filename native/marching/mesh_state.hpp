// What a Mesher holds.
#pragma once

#include <vector>

#include "marching/changes.hpp"
#include "marching/signs.hpp"
#include "marching/slots.hpp"
#include "marching/surface.hpp"
#include "riffler/marching/pick.hpp"

namespace riffler::marching {

struct MeshState {
  Volume volume;  // as it was meshed: shares its tiles
  Lattice lattice;
  Bricks bricks;
  Surface surface;               // places of bricks without a surface hold nothing of meaning
  FrozenSurface::Bricks facets;  // of those bricks that were asked for and did not change since

  /// `room`: for bricks that will grow; address space only, until it is used.
  MeshState(const Volume& volume, bool room, const Progress& progress);
  std::vector<std::size_t> update(const Volume& now);
  /// Throws std::runtime_error after an update that threw: what is here then is no mesh.
  void check_whole() const;
  std::vector<std::size_t> active_bricks() const;
  /// The mesh without the places between bricks, in the world frame.
  Mesh compact() const;
  /// The same of a state that was never updated, which then is used up.
  Mesh take();

 private:
  void build(const Progress& progress);
  void follow(const Volume& now);
  std::vector<std::size_t> mesh_again(const Changes& changes);
  void read_signs_again(const std::vector<std::size_t>& changed);
  void place_again(std::size_t brick);
  void give_place(ActiveBrick& brick);
  void give_room();
  std::vector<std::size_t> around(const std::vector<std::size_t>& list, int from, int to) const;
  /// A brick beside changed ones, where its vertices were that had a choice or were pulled, and the cells of the
  /// pulled.
  struct BrickSnapshot {
    std::size_t brick;
    std::vector<std::pair<std::int32_t, Vec3>> places;
    std::vector<Vec3i> pulled;
  };
  BrickSnapshot unsettle(std::size_t brick);
  bool moved(const BrickSnapshot& was) const;
  void choose_again(const std::vector<std::size_t>& fresh, const std::vector<BrickSnapshot>& unsettled);
  std::vector<std::size_t> unfold_again(const std::vector<std::size_t>& fresh);
  std::vector<QuadRef> quads_to_look_at(const std::vector<std::size_t>& list);

  SignReader reader_;
  Slots vertices_, quads_;
  bool room_;
  bool broken_ = false;  // an update threw: build all anew
};

}  // namespace riffler::marching
