// The state of a Mesher.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "marching/adaptive_state.hpp"
#include "marching/changes.hpp"
#include "marching/signs.hpp"
#include "marching/slots.hpp"
#include "marching/surface.hpp"
#include "riffler/marching/pick.hpp"

namespace riffler::marching {

struct MeshState {
  Volume volume;  // as meshed: shares its tiles
  Lattice lattice;
  Bricks bricks;
  Surface surface;               // entries of bricks without a surface are meaningless
  FrozenSurface::Bricks facets;  // of the bricks that were queried and have not changed since

  /// The triangles that a tolerance leaves; null: all of them.
  std::unique_ptr<AdaptiveState> adaptive;

  /// `room`: reserve space for bricks to grow, for updates; only address space until it is used.
  /// `hollow`: leave out most of what only the full mesh needs. Then simplify() must follow, and no update.
  MeshState(const Volume& volume, bool room, const Progress& progress, bool hollow = false);
  /// Leaves out the triangles that are not needed for `tolerance` (mm, > 0), now and, with room, after each update.
  void simplify(double tolerance, const Progress& progress);
  /// `normals`: also returns the bricks whose triangles are the same, but whose normals at corners may differ.
  std::vector<std::size_t> update(const Volume& now, bool normals);
  /// Throws std::runtime_error after an update that threw, because the state is then no mesh.
  void check_whole() const;
  std::vector<std::size_t> active_bricks() const;
  /// Number of a brick's triangles.
  std::size_t triangles(std::size_t brick) const;
  /// The mesh without the gaps between bricks, in the world frame.
  Mesh compact() const;
  /// Same for a state that was never updated; the state is consumed.
  Mesh take();

 private:
  template <class ForTriangles>
  Mesh renumbered(const std::vector<std::size_t>& all, const ForTriangles& for_triangles) const;
  Mesh compact_full() const;
  void build(const Progress& progress);
  void follow(const Volume& now);
  /// Bricks whose triangles, or whose normals at corners, may be others than before.
  struct Renewed {
    std::vector<std::size_t> meshed, shaded;
  };
  Renewed mesh_again(const Changes& changes);
  void read_signs_again(const std::vector<std::size_t>& changed);
  void place_again(std::size_t brick);
  void give_place(ActiveBrick& brick);
  void check_memory() const;
  void give_room();
  std::vector<std::size_t> around(const std::vector<std::size_t>& list, int from, int to) const;
  /// A brick next to changed ones: the previous places of its vertices that had a choice or were pulled, and the cells
  /// of the pulled ones.
  struct BrickSnapshot {
    std::size_t brick;
    std::vector<std::pair<std::int32_t, Vec3>> places;
    std::vector<Vec3i> pulled;
  };
  BrickSnapshot unsettle(std::size_t brick);
  bool moved(const BrickSnapshot& was) const;
  void choose_again(const std::vector<std::size_t>& fresh, const std::vector<Vec3i>& undone);
  std::vector<std::size_t> entangled(const std::vector<Vec3i>& cells, const Region& region) const;
  std::vector<std::size_t> unfold_again(const std::vector<std::size_t>& fresh, const std::vector<Vec3i>& undone);
  std::vector<QuadRef> quads_to_look_at(const std::vector<std::size_t>& list);

  SignReader reader_;
  Slots vertices_, quads_;
  bool room_;
  bool broken_ = false;  // an update threw: rebuild everything
};

}  // namespace riffler::marching
