// The stress run of contact, short; budgets are real time, so what they leave out differs from run to run.
#include <gtest/gtest.h>

#include "stress/contact_run.hpp"
#include "support/effort.hpp"

namespace riffler::stress::contact_stress_test {
namespace {

constexpr int kPoses = test::cases(kPosesOfSession, 3);
constexpr long kSessions = static_cast<long>(ContactScene::kCount);  // one of each scene

TEST(ContactStress, HoldsForPartsFromTheDegenerateLimits) {
  const ContactResults results = run_contacts({.reference_every = kPoses, .poses = kPoses}, kSessions * kPoses);
  for (const ContactFailure& f : results.failures)
    ADD_FAILURE() << "pose " << f.pose << " (" << f.scene << "): " << f.problem << "\nagain: " << reproducer(f);
  EXPECT_EQ(results.scenes.size(), static_cast<std::size_t>(ContactScene::kCount));
  for (const auto& [scene, t] : results.scenes) {
    EXPECT_EQ(t.poses, kPoses);
    EXPECT_GT(3 * t.touching, kPoses) << scene << ": hardly anything touches";
    EXPECT_LT(t.touching, t.poses) << scene << ": nothing is free";
    EXPECT_GT(t.judged, 0);
  }
}

TEST(ContactStress, DrawsTheSameSessionAgain) {
  ContactResults a, b;
  for (ContactResults* r : {&a, &b}) run_contact_session({.poses = 16}, 3, *r);
  EXPECT_EQ(a.total().touching, b.total().touching);
}

}  // namespace
}  // namespace riffler::stress::contact_stress_test
