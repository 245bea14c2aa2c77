// What a verification says.
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

/// "rapid", "holder", …
const char* name_of(Kind kind);

/// Part of a tool in the machine. Beyond: above the end of its description.
enum class Member : unsigned char { Cutter, Shank, Holder, Beyond };

/// Operation counts: what a run did, and what it did not need to do.
struct VerifyStats {
  std::uint64_t moves = 0;           ///< (move, slab) pairs cut
  std::uint64_t slabs = 0;           ///< slabs of stock and fixtures simulated, once a chunk
  std::uint64_t slabs_kept = 0;      ///< slabs whose results of the run before were taken
  std::uint64_t snapshots_used = 0;  ///< slabs that were gone on with from a snapshot
  std::uint64_t probes = 0;          ///< batches of moves tried with shank and holder, or on a fixture
  std::uint64_t probed_moves = 0;    ///< moves in them
  std::uint64_t bisections = 0;      ///< batches taken apart to find out which move it was
  std::uint64_t skipped = 0;         ///< (move, slab) pairs told apart by their boxes alone

  VerifyStats& operator+=(const VerifyStats& o);
};

/// Neighbouring rows with one fault.
struct Finding {
  Kind kind;
  Member member = Member::Cutter;
  std::int32_t fixture = -1;
  std::int32_t tool = 0;
  std::int64_t row = 0, last_row = 0;
  std::int32_t line = 0, last_line = 0;  ///< 1-based; 0: no source
  /// Rapids and spindles that stand: mm³ that all rows took. Shank, holder, fixture, unknown: mm³ in the way of the
  /// worst row. Gouges and rest material: mm under or over the part's surface at the worst point.
  /// Of a slab that has had many strikes only one in sixteen is measured (simulate.cpp).
  double value = 0;
  double worst = 0;  ///< what `point` was chosen by
  Vec3 point{0};     ///< the worst, part frame
  std::string message;

  const char* unit() const {
    return kind == Kind::Machine ? "" : kind == Kind::Gouge || kind == Kind::Rest ? "mm" : "mm³";
  }
};

struct VerifyReport {
  std::vector<Finding> findings;         ///< by rows
  std::vector<std::string> not_checked;  ///< what was not asked for, and what the program's reader noted
  std::vector<double> removed;           ///< mm³, one per row; row 0: 0
  std::vector<double> seconds;           ///< s, one per row
  Volume volume;                         ///< what is left
  std::shared_ptr<const Mesh> part;      ///< or null
  VerifyStats stats;
  bool uncertain = false;  ///< coordinates were passed over or offsets assumed: other moves may have been looked at

  bool passed() const { return findings.empty() && !uncertain; }
};

/// What the reader of the program assumed or passed over was not checked.
void add_notes(VerifyReport& report, const std::vector<nc::Note>& notes);

/// The mesh of what is left and, per vertex, its distance from the part's surface: positive where rest material stands
/// on it, negative in gouges, mm.
std::pair<Mesh, std::vector<double>> deviation_of(const Volume& left, const Mesh& part, const Progress& progress = {});
/// Per vertex of the part its distance from the surface of `left`: positive where material covers it, negative where it
/// is missing; −∞ where nothing is left at all.
std::vector<double> part_map_of(const Mesh& left, const Mesh& part, const Progress& progress = {});

}  // namespace riffler::verify
