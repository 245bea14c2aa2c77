// A journal replayed leaves the bytes that the session left.
#include "riffler/session/replay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "dexel/volumes.hpp"
#include "riffler/base/error.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/haptics/sculpt_step.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/sweep/move_carver.hpp"
#include "riffler/tool/cutters.hpp"
#include "session/journal_stream.hpp"
#include "support/error_of.hpp"
#include "support/temporary_file.hpp"

namespace riffler::session::replay_test {
namespace {

using test::error_of;
using test::TemporaryFile;

const Box3 kBox{{0, 0, 0}, {40, 30, 12}};
const std::map<int, Tool> kTools{{1, cutters::ball(6, 30)}, {2, cutters::fillet(5, 1, 30)}};
const Vec3 kUp(0, 0, 1);

Journal journal(const char* directions = "xyz") {
  Journal j;
  j.set_stock({kBox, 0.4, directions, ""});
  j.add_tool(1, "{}");
  j.add_tool(2, "{}");
  return j;
}

/// A hand that wanders through the block, turns, and now and then stands.
std::vector<Pose> wander(std::mt19937& random, int rows) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  std::vector<Pose> out{{Vec3(20, 15, 11) + 10.0 * any(), kUp}};
  while (static_cast<int>(out.size()) < rows) {
    Pose next = out.back();
    if (random() % 4) next = {next.tip + 0.7 * any(), glm::normalize(next.axis + 0.1 * any())};
    out.push_back(next);
  }
  return out;
}

TEST(Replay, GivesTheBytesOfSingleMoves) {
  for (const char* directions : {"z", "xyz"}) {
    const TemporaryFile file("replay.rjournal");
    Volume session = Volume::block({kBox, 0.4, directions});
    JournalWriter writer(file.path, JournalWriter::Keep::Rules);
    writer.set_stock({kBox, 0.4, directions, ""});
    writer.add_tool(1, "{}");
    writer.add_tool(2, "{}");
    JournalStream stream(writer);
    std::mt19937 random(7);
    double time = 0, removed = 0;
    for (int k = 0; k < 8; ++k) {
      const int tool = 1 + k % 2;
      const double tolerance = k % 3 ? 0.01 : 0.05;
      sweep::MoveCarver carver(session, kTools.at(tool), {.tolerance = tolerance});
      const std::vector<Pose> poses = wander(random, 120);
      ASSERT_TRUE(stream.begin(tool, tolerance, {poses[0], time}));
      for (std::size_t row = 1; row < poses.size(); ++row) {
        JournalRow put{poses[row], time += 1e-3};
        if (!stands(poses[row - 1], poses[row])) {
          const sweep::MoveCarver::Taken taken = carver.move(poses[row - 1], poses[row], 1e-3);
          put.force = {-taken.force, -taken.torque}, put.removed = taken.removed;
        }
        removed += put.removed;
        ASSERT_TRUE(stream.put(put));
        if (random() % 40 == 0) stream.step(time);
      }
      stream.end();
    }
    ASSERT_TRUE(stream.stop());
    const Journal j = read_journal(file.path);
    double recorded = 0;
    for (const JournalStroke& stroke : j.strokes())
      for (const double r : stroke.removed) recorded += r;
    EXPECT_EQ(recorded, removed);
    EXPECT_GT(removed, 1000);
    EXPECT_TRUE(test::same_rays(replay(j, kTools), session)) << directions;
  }
}

TEST(Replay, GivesTheBytesOfTheHapticStep) {
  // A hand that rests for half a second, presses, slides and rests again: the spring comes to rest by ever smaller
  // displacements.
  Volume session = Volume::block({kBox, 0.4, "xyz"});
  sweep::MoveCarver carver(session, kTools.at(1), {.tolerance = 0.01, .removal_constant = 1e-3});
  haptics::SculptStep step(haptics::SculptSettings(), kTools.at(1), &carver, nullptr);
  const auto grip = [](double t) -> Pose {
    const double s = t < 0.5 ? 0 : std::min(t - 0.5, 1.5);
    return {{8 + 12 * s, 15 + 3 * std::sin(4 * s), 12 - 2 * s}, glm::normalize(Vec3(0.2 * std::sin(3 * s), 0, 1))};
  };
  Journal j = journal();
  JournalStroke stroke{1};
  const auto add = [&](const Pose& pose, double time, const Wrench& force, double removed) {
    stroke.poses.push_back(pose), stroke.times.push_back(time);
    stroke.forces.push_back(force), stroke.removed.push_back(removed);
  };
  step.place(grip(0));
  add(step.tool(), 0, {}, 0);
  int standing = 0;
  for (int k = 1; k <= 4000; ++k) {
    const Pose now = grip(1e-3 * k), before = grip(1e-3 * (k - 1));
    const haptics::SculptStep::Result r = step.step(now, {1e3 * (now.tip - before.tip), {}}, 1e-3);
    standing += stands(stroke.poses.back(), r.tool);
    add(r.tool, 1e-3 * k, r.on_grip, r.removed);
  }
  j.add_stroke(stroke);
  EXPECT_GT(standing, 400);
  EXPECT_LT(session.volume(), 40 * 30 * 12 - 100);
  EXPECT_TRUE(test::same_rays(replay(parse_journal(to_bytes(j), "j"), kTools), session));
}

TEST(Replay, TakesRowsThatStandForNoMoves) {
  const Pose p{{10, 10, 8}, kUp}, q{{20, 12, 7}, glm::normalize(Vec3(0.2, 0.1, 1))};
  const auto size = [](std::vector<Pose> poses) { return moves_of({1, 0.01, "", std::move(poses)}).size(); };
  EXPECT_EQ(size({p}), 1U) << "no move";
  EXPECT_EQ(size({p, p}), 2U) << "the tool, where it stands";
  EXPECT_EQ(size({p, p, p}), 2U);
  EXPECT_EQ(size({p, p, q, q, p, p}), 3U);
  const auto left = [&](std::vector<Pose> poses) {
    Journal j = journal();
    j.add_stroke({1, 0.01, "", std::move(poses)});
    return replay(j, kTools);
  };
  const auto carved = [&](const std::vector<Pose>& poses) {
    Volume volume = Volume::block({kBox, 0.4, "xyz"});
    sweep::carve(volume, kTools.at(1), poses);
    return volume;
  };
  EXPECT_TRUE(test::same_rays(left({p}), carved({p})));
  EXPECT_TRUE(test::same_rays(left({p, p}), carved({p, p})));
  EXPECT_LT(left({p, p}).volume(), left({p}).volume() - 10);
  EXPECT_TRUE(test::same_rays(left({p, p, q, q, p, p}), carved({p, q, p})));
}

TEST(Replay, UsesOnlyStrokesThatCount) {
  std::mt19937 random(9);
  Journal all = journal(), fewer = journal();
  for (int k = 0; k < 4; ++k) {
    const JournalStroke stroke{1 + k % 2, 0.01, "", wander(random, 40)};
    all.add_stroke(stroke);
    if (k < 2) fewer.add_stroke(stroke);
  }
  const Volume whole = replay(all, kTools);
  all.undo(2);
  EXPECT_TRUE(test::same_rays(replay(all, kTools), replay(fewer, kTools)));
  all.redo(2);
  EXPECT_TRUE(test::same_rays(replay(all, kTools), whole));
  EXPECT_FALSE(test::same_rays(replay(fewer, kTools), whole));
}

TEST(Replay, BeginsWithTheSnapshot) {
  const TemporaryFile file("stock.rvol");
  Journal first = journal();
  std::mt19937 random(10);
  const JournalStroke a{1, 0.01, "", wander(random, 40)}, b{2, 0.01, "", wander(random, 40)};
  first.add_stroke(a);
  save(replay(first, kTools), file.path);
  first.add_stroke(b);
  const auto with = [&](const std::string& name, double pitch = 0.4) {
    Journal j;
    j.set_stock({kBox, pitch, "xyz", name});
    j.add_tool(2, "{}");
    j.add_stroke(b);
    return j;
  };
  const std::filesystem::path folder = file.path.parent_path(), name = file.path.filename();
  EXPECT_TRUE(test::same_rays(replay(with(name), kTools, folder), replay(first, kTools)));
  EXPECT_EQ(error_of([&] { replay(with(name, 0.5), kTools, folder); }),
            "the snapshot " + name.string() + " has another frame than the journal's stock");
  EXPECT_EQ(error_of([&] { replay(with(name), kTools); }),
            "the stock is the snapshot " + name.string() + ": name its folder");
  for (const std::string& away : {std::string("../") + name.string(), file.path.string(), std::string("..")})
    EXPECT_EQ(error_of([&] { replay(with(away), kTools, folder); }),
              "the stock's snapshot must be a file's name, not \"" + away + "\"");
  EXPECT_THROW(replay(with("nowhere.rvol"), kTools, folder), FormatError);
}

TEST(Replay, NamesTheStrokeThatIsWrong) {
  EXPECT_EQ(error_of([] { replay(Journal(), kTools); }), "the journal has no stock to replay on");
  Journal j = journal();
  j.add_stroke({2, 0.01, "", {{{10, 10, 8}, kUp}, {{11, 10, 8}, kUp}}});
  EXPECT_EQ(error_of([&] { replay(j, {{1, cutters::ball(6, 30)}}); }), "stroke 0: there is no tool 2");
  j.add_stroke({1, 0.01, "", {{{10, 10, 8}, kUp}, {{11, 10, 8}, -kUp}}});
  EXPECT_EQ(error_of([&] { replay(j, kTools); }).substr(0, 25), "stroke 1: poses, row 1: t");
}

TEST(Replay, ReportsProgressAndStops) {
  Journal j = journal();
  std::mt19937 random(12);
  for (int k = 0; k < 6; ++k) j.add_stroke({1, 0.01, "", wander(random, 30)});
  std::vector<double> shares;
  replay(j, kTools, {}, [&](double share) { return shares.push_back(share), true; });
  ASSERT_GT(shares.size(), 6U);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1);
  for (const double stop : {0.0, 0.3, 0.99})
    EXPECT_THROW(replay(j, kTools, {}, [&](double share) { return share < stop; }), Cancelled) << stop;
}

}  // namespace
}  // namespace riffler::session::replay_test
