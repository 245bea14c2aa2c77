// What a verification says.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "dexel/volume.hpp"
#include "mesh/mesh.hpp"
#include "nc/program.hpp"
#include "verify/event.hpp"

namespace riffler::verify {

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
