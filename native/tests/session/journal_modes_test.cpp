// Strokes that put material on, protect it, or no longer: on disk, and replayed.
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <vector>

#include "riffler/base/error.hpp"
#include "riffler/brush/brush_dabs.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/dexel/smooth/smooth_dabs.hpp"
#include "riffler/session/journal_file.hpp"
#include "riffler/session/replay.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "session/journal_records.hpp"
#include "support/error_of.hpp"
#include "support/temporary_file.hpp"

namespace riffler::session::journal_modes_test {
namespace {

using test::error_of;
using test::TemporaryFile;

const Box3 kBox{{0, 0, 0}, {40, 30, 12}};
const std::map<int, Tool> kTools{{1, cutters::ball(6, 30)}, {2, cutters::flat(5, 30)}};
const Vec3 kUp(0, 0, 1);

Journal journal(const std::string& snapshot = "", const std::string& mask = "") {
  Journal j;
  j.set_stock({kBox, 0.4, "xyz", snapshot, mask});
  j.add_tool(1, "{}");
  j.add_tool(2, "{}");
  return j;
}

JournalStroke stroke(StrokeMode mode, int tool, std::vector<Pose> poses) {
  JournalStroke out{tool, 0.01, "", std::move(poses)};
  out.mode = mode;
  return out;
}

/// A hand that wanders near the top of the block, and turns.
std::vector<Pose> wander(std::mt19937& random, int rows) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  std::vector<Pose> out{{Vec3(20, 15, 11) + Vec3(15, 10, 2) * any(), kUp}};
  while (static_cast<int>(out.size()) < rows)
    out.push_back({out.back().tip + 0.8 * any(), glm::normalize(out.back().axis + 0.1 * any())});
  return out;
}

/// Works on a volume as a session does, without a journal.
struct Clay {
  Volume volume = Volume::block({kBox, 0.4, "xyz"});
  std::optional<Volume> mask;

  void smooth_piece(int tool, std::span<const Pose> poses, double strength) {
    std::vector<Vec3> centres;
    for (const Pose& pose : poses) centres.push_back(pose.tip);
    dexel::SmoothOptions options;
    options.radius = tool == 1 ? 3 : 2.5;
    options.strength = strength;
    options.protect = mask ? &*mask : nullptr;
    smooth_dabs(volume, centres, options);
  }

  void brush_piece(const JournalStroke& stroke) {
    brush::BrushOptions options;
    options.kind = brush_of(stroke.mode), options.radius = stroke.tool == 1 ? 3 : 2.5;
    options.strength = stroke.strength, options.amount = stroke.amount, options.falloff = stroke.falloff;
    options.protect = mask ? &*mask : nullptr;
    brush_dabs(volume, stroke.poses, options);
  }

  void carve_piece(StrokeMode mode, int tool, std::span<const Pose> poses) {
    sweep::CarveOptions options;
    if (mode == StrokeMode::Add || mode == StrokeMode::Mask) options.mode = sweep::CarveMode::Add;
    if (mode == StrokeMode::Mask || mode == StrokeMode::Unmask) {
      if (!mask) mask.emplace(volume.frame());
      sweep::carve(*mask, kTools.at(tool), poses, options);
    } else {
      if (mask) options.protect = &*mask;
      sweep::carve(volume, kTools.at(tool), poses, options);
    }
  }
};

constexpr StrokeMode kModes[] = {StrokeMode::Remove, StrokeMode::Add, StrokeMode::Mask, StrokeMode::Unmask};

TEST(JournalModes, AreReplayedToTheByteCarveByCarve) {
  std::mt19937 random(21);
  Clay clay;
  Journal j = journal();
  const std::vector<Pose> first = wander(random, 30);
  clay.carve_piece(StrokeMode::Unmask, 1, first);
  EXPECT_EQ(clay.mask->volume(), 0);
  j.add_stroke(stroke(StrokeMode::Unmask, 1, first));
  for (int k = 0; k < 24; ++k) {
    const StrokeMode mode = kModes[k % 4];
    const int tool = 1 + k % 3 / 2, rows = 25;
    const std::vector<Pose> poses = wander(random, rows);
    for (int at = 0, size = 0; at + 1 < rows; at += size) {  // as events come: any number of rows
      size = std::min<int>(1 + static_cast<int>(random() % 7), rows - 1 - at);
      const std::span<const Pose> piece = std::span(poses).subspan(at, size + 1);
      clay.carve_piece(mode, tool, piece);
      j.add_stroke(stroke(mode, tool, {piece.begin(), piece.end()}));
    }
  }
  const Replayed again = replay_all(parse_journal(to_bytes(j), "j"), kTools);
  ASSERT_TRUE(again.mask);
  EXPECT_GT(again.mask->volume(), 100);
  EXPECT_EQ(to_bytes(again.volume), to_bytes(clay.volume));
  EXPECT_EQ(to_bytes(*again.mask), to_bytes(*clay.mask));
}

TEST(JournalModes, OfDabsAreReplayedToTheByte) {
  std::mt19937 random(26);
  Clay clay;
  Journal j = journal();
  const auto carve_it = [&](StrokeMode mode, const std::vector<Pose>& poses) {
    clay.carve_piece(mode, 2, poses);
    j.add_stroke(stroke(mode, 2, poses));
  };
  carve_it(StrokeMode::Remove, wander(random, 40));
  carve_it(StrokeMode::Mask, wander(random, 20));
  const double before = clay.volume.volume();
  for (const double strength : {0.3, 1.0, 0.0}) {
    std::vector<Pose> poses;  // along an edge of the block
    for (int k = 0; k < 12; ++k) poses.push_back({Vec3(3 + 3 * k, 0.3, 11.8), kUp});
    poses.push_back(poses.back());  // that stands, and is a dab all the same
    clay.smooth_piece(1, poses, strength);
    JournalStroke dabs = stroke(StrokeMode::Soften, 1, poses);
    dabs.strength = strength;
    j.add_stroke(dabs);
  }
  EXPECT_NE(clay.volume.volume(), before);
  const Journal read = parse_journal(to_bytes(j), "j");
  EXPECT_EQ(read.strokes()[2].strength, 0.3);
  EXPECT_EQ(to_bytes(replay_all(read, kTools).volume), to_bytes(clay.volume));
  JournalStroke wrong = stroke(StrokeMode::Soften, 1, wander(random, 2));
  wrong.strength = 1.5;
  EXPECT_EQ(error_of([&] { j.add_stroke(wrong); }), "strength must be from 0 to 1");
}

TEST(JournalModes, OfBrushesAreReplayedToTheByte) {
  std::mt19937 random(27);
  Clay clay;
  Journal j = journal();
  const std::vector<Pose> grooves = wander(random, 40), kept = wander(random, 20);
  clay.carve_piece(StrokeMode::Remove, 2, grooves), j.add_stroke(stroke(StrokeMode::Remove, 2, grooves));
  clay.carve_piece(StrokeMode::Mask, 2, kept), j.add_stroke(stroke(StrokeMode::Mask, 2, kept));
  int changed = 0;
  for (std::uint32_t k = 0; k < brush::kKinds; ++k) {
    JournalStroke dabs = stroke(static_cast<StrokeMode>(kFirstBrush + k), 1 + k % 2, wander(random, 3));
    dabs.strength = 0.4 + 0.05 * k, dabs.amount = k % 2 ? 0.3 : -0.4;
    dabs.falloff = static_cast<brush::Falloff>(k % brush::kFalloffs);
    const double before = clay.volume.volume();
    clay.brush_piece(dabs);
    changed += clay.volume.volume() != before;
    j.add_stroke(dabs);
  }
  EXPECT_GE(changed, 6) << "some of the places are not on a surface";
  const Journal read = parse_journal(to_bytes(j), "j");
  EXPECT_EQ(read.strokes()[3].strength, 0.45);
  EXPECT_EQ(read.strokes()[3].amount, 0.3);
  EXPECT_EQ(read.strokes()[3].falloff, brush::Falloff::Smoother);
  EXPECT_EQ(to_bytes(replay_all(read, kTools).volume), to_bytes(clay.volume));
  JournalStroke wrong = stroke(static_cast<StrokeMode>(kFirstBrush), 1, wander(random, 2));
  wrong.amount = INFINITY;
  EXPECT_EQ(error_of([&] { j.add_stroke(wrong); }), "amount must be finite");
}

TEST(JournalModes, ContinueFromAStockThatHasAMask) {
  std::mt19937 random(22);
  const TemporaryFile stock("stock.rvol"), mask("mask.rvol");
  Clay clay;
  clay.carve_piece(StrokeMode::Mask, 1, wander(random, 40));
  clay.carve_piece(StrokeMode::Remove, 2, wander(random, 40));
  save(clay.volume, stock.path);
  save(*clay.mask, mask.path);
  const std::string names[] = {stock.path.filename(), mask.path.filename()};
  Journal j = journal(names[0], names[1]);
  const std::vector<Pose> poses = wander(random, 60);
  clay.carve_piece(StrokeMode::Remove, 1, poses);
  j.add_stroke(stroke(StrokeMode::Remove, 1, poses));
  const Journal read = parse_journal(to_bytes(j), "j");
  EXPECT_EQ(read.stock()->mask, names[1]);
  const Replayed again = replay_all(read, kTools, stock.path.parent_path());
  EXPECT_EQ(to_bytes(again.volume), to_bytes(clay.volume));
  EXPECT_EQ(to_bytes(*again.mask), to_bytes(*clay.mask));
  EXPECT_EQ(error_of([&] { replay(journal(names[0], "../" + names[1]), kTools, stock.path.parent_path()); }),
            "the mask's snapshot must be a file's name, not \"../" + names[1] + "\"");
}

TEST(JournalModes, OfRemovalAloneKeepTheirOldBytes) {
  std::mt19937 random(23);
  Journal j = journal();
  j.add_stroke(stroke(StrokeMode::Remove, 1, wander(random, 5)));
  const std::vector<std::uint8_t> bytes = to_bytes(j);
  const auto kinds = [](const std::vector<std::uint8_t>& data) {
    std::vector<std::uint32_t> out;
    for (std::size_t at = journal_format::check_header(data, "j"); at < data.size();) {
      const auto record = journal_format::whole_record(std::span(data).subspan(at));
      out.push_back(record->kind);
      at += record->size;
    }
    return out;
  };
  EXPECT_EQ(kinds(bytes), (std::vector<std::uint32_t>{1, 2, 2, 4}));
  Journal clay = journal("a", "b");
  clay.add_stroke(stroke(StrokeMode::Add, 1, wander(random, 5)));
  EXPECT_EQ(kinds(to_bytes(clay)), (std::vector<std::uint32_t>{9, 2, 2, 8})) << "older readers name the newer kind";
  EXPECT_EQ(parse_journal(to_bytes(clay), "j").strokes()[0].mode, StrokeMode::Add);
}

TEST(JournalModes, OfANewerRifflerAreNamed) {
  Journal j = journal();
  std::mt19937 random(24);
  j.add_stroke(stroke(StrokeMode::Unmask, 1, wander(random, 5)));
  const std::size_t at = to_bytes(journal()).size();
  std::vector<std::uint8_t> bytes = to_bytes(j);
  const auto record = journal_format::whole_record(std::span(bytes).subspan(at));
  std::vector<std::uint8_t> payload(record->payload.begin(), record->payload.end());
  payload[payload.size() - 4] = kStrokeModes;
  Journal out = journal();
  EXPECT_EQ(error_of([&] { journal_format::apply_record({record->kind, payload, record->size}, out); }),
            "a stroke of mode " + std::to_string(kStrokeModes) + ", unknown here: a newer Riffler wrote it");
  payload[payload.size() - 4] = 1;
  journal_format::apply_record({record->kind, payload, record->size}, out);
  EXPECT_EQ(out.strokes()[0].mode, StrokeMode::Add);
}

TEST(JournalModes, GiveMachinesOnlyStrokesThatTheyCanMake) {
  std::mt19937 random(25);
  Journal all = journal(), removal = journal();
  for (const StrokeMode mode : kModes) {
    const JournalStroke s = stroke(mode, 1, wander(random, 9));
    all.add_stroke(s);
    if (mode == StrokeMode::Remove) removal.add_stroke(s);
  }
  JournalProgramOptions options;
  options.feed = 600;
  const nc::Program program = to_program(all, kTools, options), removing = to_program(removal, kTools, options);
  EXPECT_GT(removing.size(), 9U);
  EXPECT_EQ(program.size(), removing.size());
}

}  // namespace
}  // namespace riffler::session::journal_modes_test
