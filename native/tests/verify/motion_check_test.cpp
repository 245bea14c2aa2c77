// What is looked at, and what is found, when the motion of a program is checked before it is written.
#include "verify/motion_check.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "riffler/nc/write/writer.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/box_mesh.hpp"
#include "support/error_of.hpp"

namespace riffler::verify::motion_check_test {
namespace {

using test::box_mesh;
using test::error_of;

nc::Program through(const std::vector<Vec3>& tips) {
  nc::Program p;
  for (std::size_t k = 0; k < tips.size(); ++k) p.append({{tips[k], {0, 0, 1}}, k ? 500.0 : 0.0, 9000, 1, 0, k == 0});
  p.tools.emplace(1, cutters::flat(6, 30).with_holder({{30, 20, 60, 20}}));
  return p;
}

nc::MachineMotion motion_of(const nc::Program& p, const char* post = "3-axis") {
  nc::WriteOptions how;
  how.post = post, how.motion = true;
  nc::WriteReport report;
  to_nc(p, how, &report);
  return report.motion;
}

TEST(MotionCheck, VisitsOnlyNearMoves) {
  const collide::Collider collider(box_mesh({0, 0, 0}, {40, 40, 20}));
  std::vector<Vec3> far;
  for (int k = 0; k < 500; ++k) far.emplace_back(k, 100, 5);
  far.emplace_back(500, 100, 50);
  for (int k = 0; k < 500; ++k) far.emplace_back(500 - k, 20, 50);
  nc::Program p = through(far);
  std::size_t swept = 0;
  refuse_collisions(p, motion_of(p), collider, 0.05, &swept);
  EXPECT_EQ(swept, 0U) << "nothing comes near";
  far.emplace_back(20, 20, 20);  // the cutter touches the top
  p = through(far);
  refuse_collisions(p, motion_of(p), collider, 0.05, &swept);
  EXPECT_EQ(swept, 1U);
}

TEST(MotionCheck, NamesTheRowTheObstacleTheDepthAndThePlace) {
  const collide::Collider collider(box_mesh({0, 0, 0}, {40, 40, 20}));
  const auto error = [&](const std::vector<Vec3>& tips) {
    const nc::Program p = through(tips);
    return error_of([&] { refuse_collisions(p, motion_of(p), collider, 0.05); });
  };
  EXPECT_EQ(error({{20, 20, 60}, {20, 20, 19.96}}), "");
  const std::string deep = error({{20, 20, 60}, {20, 20, 30}, {20, 20, 19.5}, {80, 20, 19.5}});
  EXPECT_TRUE(deep.starts_with("poses, row 2: on the feed move there the cutter meets the part, 0.5 mm deep, at ["))
      << deep;
  // Beside the block the cutter is free, and the holder is not.
  const std::string holder = error({{-10, 20, 60}, {-10, 20, -10.5}});
  EXPECT_TRUE(holder.starts_with("poses, row 1: on the feed move there the holder meets the part, 0.5 mm deep, at ["))
      << holder;
  EXPECT_EQ(error({{-10, 20, 60}, {-10, 20, -10}}), "");
  // To its first row a tool comes down.
  EXPECT_TRUE(error({{20, 20, 10}, {20, 20, 60}}).starts_with("poses, row 0: coming down to it the cutter meets"));
  nc::Program unknown = through({{20, 20, 60}, {20, 20, 30}});
  unknown.tools.clear();
  EXPECT_NE(error_of([&] { refuse_collisions(unknown, motion_of(unknown), collider, 0.05); }).find("has no shape"),
            std::string::npos);
}

TEST(MotionCheck, IsDoneBeforeAFileIsWritten) {
  const nc::Program p = through({{20, 20, 60}, {20, 20, 10}});
  const auto path = std::filesystem::temp_directory_path() / "riffler_motion_check_test.ngc";
  nc::WriteOptions how;
  how.post = "3-axis", how.motion = true;
  const collide::Collider collider(box_mesh({0, 0, 0}, {40, 40, 20}));
  EXPECT_THROW(write_nc(p, path, how,
                        [&](const nc::WriteReport& written) { refuse_collisions(p, written.motion, collider, 0.05); }),
               nc::RowError);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(MotionCheck, RunsOnTheStockOfThatMoment) {
  const Volume stock = Volume::block({{{0, 0, 0}, {40, 40, 20}}, 0.5, "z"});
  // A slot in two passes: the second one's rapid goes where the first has cut.
  nc::Program p;
  const auto add = [&](const Vec3& tip, bool rapid) {
    p.append({{tip, {0, 0, 1}}, rapid ? 0.0 : 500.0, 9000, 1, 0, rapid});
  };
  p.tools.emplace(1, cutters::flat(6, 30));
  add({-10, 20, 40}, true), add({-10, 20, 15}, true), add({50, 20, 15}, false), add({50, 20, 15}, true);
  add({-10, 20, 15}, true);
  EXPECT_EQ(error_of([&] { refuse_strikes(p, motion_of(p), stock, 0.01); }), "");
  add({-10, 20, 12}, true), add({20, 20, 12}, true);
  const std::string said = error_of([&] { refuse_strikes(p, motion_of(p), stock, 0.01); });
  EXPECT_TRUE(said.starts_with("poses, row 6: on the move there at [")) << said;
  EXPECT_NE(said.find("a rapid takes"), std::string::npos) << said;
}

}  // namespace
}  // namespace riffler::verify::motion_check_test
