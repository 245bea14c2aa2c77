// The meshing stress run: meshes volumes from the degenerate limits and checks each mesh.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "stress/mesh_checks.hpp"
#include "stress/mesh_scenes.hpp"

namespace riffler::stress {

struct MeshOptions {
  std::uint64_t seed = 1;
  /// Mesh with tolerances from a fiftieth of the pitch to a thousand pitches, instead of without.
  bool tolerant = false;
  int threads_every = 16;  ///< volumes between two that are meshed with 1 and with 4 threads
};

/// A failed check, with the numbers that reproduce it.
struct MeshFailure {
  std::uint64_t seed, number;
  MeshScene scene;
  Problem problem;
  bool tolerant = false;
};

struct MeshTally {
  long volumes = 0, empty = 0, triangles = 0, failures = 0;
};

struct MeshResults {
  std::array<MeshTally, static_cast<std::size_t>(MeshScene::kCount)> scenes;
  long thread_checks = 0;
  std::vector<MeshFailure> failures;  ///< the first few
  MeshTally total() const;
};

/// Scene of volume number `number`, which depends only on the seed and the number.
MeshScene mesh_scene(std::uint64_t number);
Volume mesh_volume(std::uint64_t seed, std::uint64_t number);

/// Tolerance for volume number `number` with options.tolerant, mm.
double mesh_tolerance(const Volume& volume, std::uint64_t number);
/// The check that these options ask for.
Problem check_volume_number(const MeshOptions& options, std::uint64_t number, const Volume& volume, bool threads,
                            std::size_t* triangles = nullptr);

/// Adds volume `number` to the results.
void run_volume(const MeshOptions& options, std::uint64_t number, MeshResults& out);

/// Runs volumes 0 … `volumes` − 1. `progress` is called after each volume and may stop the run by returning false.
MeshResults run_meshes(const MeshOptions& options, std::uint64_t volumes,
                       const std::function<bool(const MeshResults&)>& progress = {});

/// The command that draws the failed volume again and writes the smallest part of it that fails.
std::string reproducer(const MeshFailure& failure);

}  // namespace riffler::stress
