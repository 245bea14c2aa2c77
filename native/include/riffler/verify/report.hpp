// The result of a verification.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::verify {

enum class Kind : unsigned char { Rapid, Holder, Shank, Fixture, Gouge, Rest, Spindle, Machine, Unknown };

/// The kind as text: "rapid", "holder", …
const char* name_of(Kind kind);

/// Part of a tool in the machine. Beyond: above the end of its described shape.
enum class Member : unsigned char { Cutter, Shank, Holder, Beyond };

/// Operation counts: what a run did, and what it could skip.
struct VerifyStats {
  std::uint64_t moves = 0;           ///< (move, slab) pairs cut
  std::uint64_t slabs = 0;           ///< slabs of stock and fixtures simulated, once per chunk
  std::uint64_t slabs_kept = 0;      ///< slabs reused from the previous run
  std::uint64_t snapshots_used = 0;  ///< slabs resumed from a snapshot
  std::uint64_t probes = 0;          ///< batches of moves tested with shank and holder, or on a fixture
  std::uint64_t probed_moves = 0;    ///< moves in them
  std::uint64_t bisections = 0;      ///< batches split to find the colliding move
  std::uint64_t skipped = 0;         ///< (move, slab) pairs rejected by their boxes alone

  VerifyStats& operator+=(const VerifyStats& o);
};

/// A run of neighbouring rows with one fault.
struct Finding {
  Kind kind;
  Member member = Member::Cutter;
  std::int32_t fixture = -1;
  std::int32_t tool = 0;
  std::int64_t row = 0, last_row = 0;
  std::int32_t line = 0, last_line = 0;  ///< 1-based; 0: no source
  /// Rapid and Spindle: mm³ removed by all rows. Shank, Holder, Fixture, Unknown: mm³ obstructing the worst row.
  /// Gouge and Rest: mm below or above the part's surface at the worst point. In a slab with very many collisions only
  /// one in sixteen is measured (simulate.cpp).
  double value = 0;
  double worst = 0;  ///< the value by which `point` was chosen
  Vec3 point{0};     ///< the worst point, mm, part frame
  std::string message;

  const char* unit() const {
    return kind == Kind::Machine ? "" : kind == Kind::Gouge || kind == Kind::Rest ? "mm" : "mm³";
  }
};

/// Findings and measurements of a verification.
struct VerifyReport {
  std::vector<Finding> findings;         ///< in row order
  std::vector<std::string> not_checked;  ///< checks not requested, and notes of the NC reader
  std::vector<double> removed;           ///< mm³, one per row; row 0: 0
  std::vector<double> seconds;           ///< s, one per row
  Volume volume;                         ///< the stock after the program
  std::shared_ptr<const Mesh> part;      ///< may be null
  VerifyStats stats;
  bool uncertain = false;  ///< the reader skipped coordinates or assumed offsets: the real moves may differ

  bool passed() const { return findings.empty() && !uncertain; }
};

/// Adds the assumptions and omissions of the NC reader to `not_checked`.
void add_notes(VerifyReport& report, const std::vector<nc::Note>& notes);

/// The mesh of the remaining stock `left` and, per vertex, its distance from the part's surface in mm: positive for
/// rest material, negative in gouges.
std::pair<Mesh, std::vector<double>> deviation_of(const Volume& left, const Mesh& part, const Progress& progress = {});
/// Per vertex of `part`, the distance from the surface of `left` in mm: positive where material covers it, negative
/// where material is missing; −∞ if nothing is left at all.
std::vector<double> part_map_of(const Mesh& left, const Mesh& part, const Progress& progress = {});

}  // namespace riffler::verify
