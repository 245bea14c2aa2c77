#include "plan/pick.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace riffler::plan::pick_test {
namespace {

PencilPath path() {
  PencilPath p;
  p.radius = 1;
  for (int k = 0; k < 5; ++k) {
    p.centres.emplace_back(k, 0, 1);
    p.contacts.push_back({Vec3(k, 0, 0), Vec3(k, 1, 1)});
    p.normals.push_back({Vec3(0, 0, 1), Vec3(0, -1, 0)});
  }
  return p;
}

TEST(Pick, NamesTheNearestContactItsSideAndNormal) {
  const Picked a = nearest_contact(path(), Vec3(2.2, 0, -3));
  EXPECT_EQ(a.index, 2U);
  EXPECT_EQ(a.side, 0);
  EXPECT_EQ(a.normal, Vec3(0, 0, 1));
  EXPECT_NEAR(a.distance, std::hypot(0.2, 3), 1e-15);
  const Picked b = nearest_contact(path(), Vec3(3.9, 1, 1));
  EXPECT_EQ(b.index, 4U);
  EXPECT_EQ(b.side, 1);
  EXPECT_EQ(b.point, Vec3(4, 1, 1));
}

TEST(Pick, ByARaySearchesForwardOnly) {
  const Picked a = nearest_contact(path(), {3.1, 0, 10}, {0, 0, -7});
  EXPECT_EQ(a.index, 3U);
  EXPECT_EQ(a.side, 0);
  EXPECT_NEAR(a.distance, 0.1, 1e-15);
  const Picked away = nearest_contact(path(), {3.1, 0, 10}, {0, 0, 1});
  EXPECT_EQ(away.side, 1) << "behind: as far as from the origin";
  EXPECT_NEAR(away.distance, std::sqrt(81 + 1 + 0.01), 1e-12);
}

TEST(Pick, RefusesNothingToPickAndNoDirection) {
  EXPECT_THROW(nearest_contact(PencilPath{}, Vec3(0)), std::invalid_argument);
  EXPECT_THROW(nearest_contact(path(), Vec3(0), Vec3(0)), std::invalid_argument);
  EXPECT_THROW(nearest_contact(path(), Vec3(std::nan(""), 0, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::plan::pick_test
