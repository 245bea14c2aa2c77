// Sessions that plan by feel, with their threads, on the clock of the system.
#include "riffler/session/orient_session.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "geom/math.hpp"
#include "pen/simulated/simulated_device.hpp"
#include "riffler/pen/pointer.hpp"
#include "session/orient_bench.hpp"
#include "support/error_of.hpp"

namespace riffler::session::orient_session_test {
namespace {

using test::edge_path;
using test::leaning;

std::shared_ptr<const collide::Collider> part() {
  static const auto made = std::make_shared<collide::Collider>(test::corner());
  return made;
}

/// A tablet whose plane is the xy plane at the height of the path's tips: its tilt turns the tool.
struct TabletBench {
  explicit TabletBench(const OrientSessionSettings& settings = {}, const plan::PencilPath& path = edge_path())
      : pen(std::make_shared<pen::PointerPen>(pen::PointerPen::Kind::Tablet,
                                              pen::PointerFrame{.origin = {0, 0, 0}, .depth = 1})) {
    at(20, 0.5);
    session = std::make_unique<OrientSession>(path, test::wide_shank(), pen, part(), settings);
    session->start();
  }

  /// The pen at this x, leaning from the wall by `angle`, with these buttons.
  void at(double x, double angle, std::uint32_t buttons = 0) {
    time += 0.004;
    pen->give({.x = x, .y = 3, .tilt_y = angle, .buttons = buttons, .time = time});
  }
  /// Moves there in small steps, then presses.
  void press(double x, double angle, std::uint32_t buttons) {
    for (int k = 0; k < 25; ++k) at(x, angle), nap(0.004);
    nap(0.03);
    at(x, angle, buttons);
    // Held until it counts: on a busy machine the session's thread may come late.
    for (int k = 0; k < 500; ++k) {
      const OrientFrame frame = session->frame();
      changes.insert(changes.end(), frame.changes.begin(), frame.changes.end());
      if (!frame.changes.empty()) break;
      nap(0.01);
    }
    at(x, angle), nap(0.03);
  }
  static void nap(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

  double time = 0;
  std::shared_ptr<pen::PointerPen> pen;
  std::unique_ptr<OrientSession> session;
  std::vector<KeyChange> changes;
};

TEST(OrientSession, ButtonsSetReplaceAndDeleteKeysAndThePathFollows) {
  TabletBench bench;
  bench.press(5, 0.6, 1);
  bench.press(30, 0.9, 1);
  ASSERT_EQ(bench.session->keys().size(), 2U);
  EXPECT_EQ(bench.session->keys().begin()->first, 3U);
  EXPECT_NEAR(bench.session->keys().begin()->second.y, std::sin(0.6), 0.02);
  EXPECT_EQ(bench.session->path().axes.size(), 37U);
  bench.press(30, 0.4, 1);
  ASSERT_EQ(bench.session->keys().size(), 2U);
  EXPECT_NEAR(bench.session->keys().rbegin()->second.y, std::sin(0.4), 0.02);
  bench.press(18, 0.4, 2);  // no key within 2 mm
  bench.press(4, 0.4, 2);
  EXPECT_EQ(bench.session->keys().size(), 1U);
  ASSERT_EQ(bench.changes.size(), 5U);
  EXPECT_EQ(bench.changes[3].refused, "there is no key here to delete");
  EXPECT_TRUE(bench.changes[4].deleted && bench.changes[4].refused.empty());
  EXPECT_EQ(bench.changes[4].point, 3U);
  bench.session->stop();
  EXPECT_FALSE(bench.session->running());
}

TEST(OrientSession, BeginsWithThePathsKeysAndAcceptsOthers) {
  plan::PencilPath path =
      plan::oriented(edge_path(), {{0, leaning(0.5)}, {36, leaning(0.7)}}, plan::Interpolation::Slerp);
  TabletBench bench({}, path);
  EXPECT_EQ(bench.session->keys().size(), 2U);
  bench.session->set_keys({{5, leaning(1)}});
  EXPECT_EQ(bench.session->path().axes[30], leaning(1));
  EXPECT_NE(test::error_of([&] { bench.session->set_keys({{50, leaning(1)}}); }), "");
  EXPECT_EQ(bench.session->keys().size(), 1U);
  bench.session->set_keys({});
  EXPECT_TRUE(bench.session->keys().empty());
}

TEST(OrientSession, AKeyBeyondTheMachineIsRefusedWithTheReason) {
  OrientSessionSettings settings;
  settings.limit = plan::AxisLimit{{0, 0, 1}, 0.3, false};
  TabletBench bench(settings);
  bench.press(10, 0.6, 1);
  ASSERT_EQ(bench.changes.size(), 1U);
  EXPECT_NE(bench.changes[0].refused, "");
  EXPECT_TRUE(bench.session->keys().empty());
}

TEST(OrientSession, ASimulatedPenPushesAndStops) {
  const std::shared_ptr<pen::SimulatedDevice> pen = pen::SimulatedDevice::open();
  OrientSessionSettings settings;
  settings.point = 18, settings.axis = leaning(0.5);
  settings.loop.passivity = pen->passivity();
  OrientSession session(edge_path(), test::wide_shank(), pen, part(), settings);
  session.start();
  bool active = false;
  for (int k = 0; k < 400 && !active; ++k) {
    TabletBench::nap(0.01);
    for (const OrientTick& tick : session.frame().ticks) active = active || tick.state == haptics::ForceState::Active;
  }
  EXPECT_TRUE(active);
  session.stop();
  EXPECT_FALSE(session.running());
  EXPECT_TRUE(session.stop().ticks.empty());
}

/// A part of one triangle is a part.
TEST(OrientSession, TakesAPartOfOneTriangle) {
  Mesh one;
  one.vertices = {{0, 0, 0}, {40, 0, 0}, {0, 0, 60}};
  one.triangles = {{0, 1, 2}};
  const auto pen = std::make_shared<pen::PointerPen>(pen::PointerPen::Kind::Tablet);
  OrientSession session(edge_path(), test::wide_shank(), pen, std::make_shared<collide::Collider>(one), {});
  session.start();
  pen->give({.x = 10, .y = 3, .tilt_y = -0.3, .time = 1});
  TabletBench::nap(0.1);
  EXPECT_GT(session.stop().ticks.size(), 10U);
}

TEST(OrientSession, NamesWhatItRefuses) {
  const auto pen = std::make_shared<pen::PointerPen>(pen::PointerPen::Kind::Tablet);
  const Tool tool = test::wide_shank();
  EXPECT_NE(test::error_of([&] { OrientSession(edge_path(), tool, nullptr, part(), {}); }), "");
  EXPECT_NE(test::error_of([&] { OrientSession(edge_path(), tool, pen, nullptr, {}); }), "");
  EXPECT_EQ(test::error_of([&] { OrientSession({}, tool, pen, part(), {}); }), "the path has no points");
  OrientSessionSettings settings;
  settings.point = 99;
  EXPECT_NE(test::error_of([&] { OrientSession(edge_path(), tool, pen, part(), settings); }), "");
  settings = {};
  settings.reach = -1;
  EXPECT_NE(test::error_of([&] { OrientSession(edge_path(), tool, pen, part(), settings); }), "");
}

}  // namespace
}  // namespace riffler::session::orient_session_test
