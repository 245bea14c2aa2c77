// The sixth encoder's use: lost counts and bad homings show in the grip's length.
#include "pen/arms/redundancy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/pens.hpp"

namespace riffler::pen::redundancy_test {
namespace {

std::vector<EncoderCounts> postures(const PenKinematics& pen, int wanted, std::uint64_t seed) {
  stress::Random random(seed);
  std::vector<EncoderCounts> out;
  while (static_cast<int>(out.size()) < wanted) {
    const PenInverse inverse = pen.inverse(test::random_pose(random, pen.geometry()));
    if (inverse.reached()) out.push_back(pen.counts(inverse.angles));
  }
  return out;
}

bool fits(const PenKinematics& pen, EncoderCounts counts, std::size_t channel = 0, int wrong = 0) {
  counts[channel] += wrong;
  return check_grip(pen, pen.posture(counts)).fits;
}

TEST(GripCheck, CountsThatAreRightFit) {
  const PenKinematics pen(test::turned_pen());
  double worst = 0;
  for (const EncoderCounts& counts : postures(pen, 20000, 31)) {
    const GripCheck check = check_grip(pen, pen.posture(counts));
    EXPECT_TRUE(check.fits);
    worst = std::max(worst, std::abs(check.stretch));
  }
  EXPECT_LT(worst, 0.08) << "what rounding to counts can do, and a third of the tolerance";
}

TEST(GripCheck, EveryLostCountIsFoundBeyondTheStatedNumber) {
  PenGeometry geometry = test::turned_pen();
  geometry.channels[1].sign = geometry.channels[5].sign = -1;
  geometry.channels[5].home = -geometry.channels[5].home;
  const PenKinematics pen(geometry);
  int found = 0;
  for (const EncoderCounts& counts : postures(pen, 60, 32)) {
    const auto stated = noticed_counts(pen, pen.posture(counts));
    for (std::size_t channel = 0; channel < kPenChannels; ++channel)
      for (const int way : {-1, 1}) {
        const double least = way < 0 ? stated[channel].few : stated[channel].many;
        // One by one: the first that does not fit is the first beyond what is stated.
        int first = 1;
        while (first < 4000 && fits(pen, counts, channel, way * first)) ++first;
        if (first < 4000) {
          EXPECT_EQ(first, static_cast<int>(std::floor(least)) + 1) << "channel " << channel << " sign " << way;
          ++found;
        } else {
          EXPECT_GT(least, 3998);
        }
      }
  }
  EXPECT_GT(found, 650) << "of 720";
}

TEST(GripCheck, AtHomeTheForeArmsCountsShowAtOnceAndTheOthersHardly) {
  const PenKinematics pen(load_pen("riffler"));
  const auto stated = noticed_counts(pen, pen.posture(pen.home_angles()));
  // 180 mm of fore arm along the grip: 0.25 mm is 10.6 counts of 48000.
  EXPECT_NEAR(stated[1].many, 0.25 / 180 * 48000 / 6.283185307, 0.1);
  EXPECT_NEAR(stated[4].few, 0.25 / 180 * 48000 / 6.283185307, 0.1);
  EXPECT_GT(stated[0].many, 100) << "the upper arm hangs: the grip changes in the second order";
  EXPECT_GT(stated[2].many, 100) << "the first joint moves the end square to the grip";
}

TEST(GripCheck, SwappedPlugsDoNotFit) {
  const PenKinematics pen(load_pen("riffler"));
  int arms = 0, joints = 0, all = 0;
  for (const EncoderCounts& c : postures(pen, 2000, 38)) {
    arms += fits(pen, {c[3], c[4], c[5], c[0], c[1], c[2]});
    joints += fits(pen, {c[1], c[0], c[2], c[3], c[4], c[5]});
    ++all;
  }
  EXPECT_EQ(arms, 0) << "R and L, of " << all;
  EXPECT_LT(joints, all / 50) << "joints 2 and 3 of R: where both have the same count it cannot show";
}

TEST(GripCheck, NanIsNotAFit) {
  const PenKinematics pen(load_pen("riffler"));
  PenPosture posture = pen.posture(pen.home_angles());
  posture.length = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(check_grip(pen, posture).fits);
  for (const NoticedCounts& none : noticed_counts(pen, posture)) EXPECT_EQ(none.many, 0);
}

GripVerdict verdict(const PenKinematics& pen, const std::vector<EncoderCounts>& right, const EncoderCounts& wrong) {
  GripDiagnosis diagnosis(pen);
  for (EncoderCounts counts : right) {
    for (std::size_t k = 0; k < kPenChannels; ++k) counts[k] += wrong[k];
    diagnosis.add(pen.posture(counts));
  }
  return diagnosis.verdict();
}

TEST(GripDiagnosis, FindsTheChannelThatLostCountsAndHowMany) {
  const PenKinematics pen(load_pen("riffler"));
  const auto right = postures(pen, 60, 33);
  EXPECT_EQ(verdict(pen, right, {}).fault, GripFault::None);
  for (std::size_t channel = 0; channel < kPenChannels; ++channel)
    for (const int lost : {-2000, -500, -100, -60, 60, 100, 500, 2000}) {
      EncoderCounts wrong{};
      wrong[channel] = lost;
      const GripVerdict found = verdict(pen, right, wrong);
      EXPECT_EQ(found.fault, GripFault::Channel) << channel << " " << lost;
      EXPECT_EQ(found.channel, channel) << lost;
      EXPECT_NEAR(found.counts, lost, 3) << channel;
      EXPECT_LT(found.left, 0.03);
    }
}

TEST(GripDiagnosis, DistinguishesABadHomingFromALostCount) {
  const PenKinematics pen(load_pen("riffler"));
  const auto right = postures(pen, 60, 34);
  stress::Random random(35);
  int several = 0;
  constexpr int kRounds = 100;
  for (int round = 0; round < kRounds; ++round) {
    EncoderCounts wrong{};
    for (std::int32_t& count : wrong) count = random.below(600) - 300;
    const GripVerdict found = verdict(pen, right, wrong);
    EXPECT_NE(found.fault, GripFault::None);
    several += found.fault == GripFault::Several;
  }
  EXPECT_GE(several, kRounds - 2) << "all joints up to 300 counts (2.3°) off";
}

TEST(GripDiagnosis, IsUnclearIfThePenStoodStill) {
  const PenKinematics pen(load_pen("riffler"));
  EncoderCounts counts = pen.counts(pen.home_angles());
  counts[1] += 50;
  GripDiagnosis diagnosis(pen);
  for (int k = 0; k < 1000; ++k) counts[2] += k % 2 ? 1 : -1, diagnosis.add(pen.posture(counts));
  EXPECT_EQ(diagnosis.postures(), 1U);
  EXPECT_EQ(diagnosis.verdict().fault, GripFault::Unclear);
}

TEST(GripDiagnosis, KeepsTheLastPosturesOnly) {
  const PenKinematics pen(load_pen("riffler"));
  GripDiagnosis diagnosis(pen);
  for (const EncoderCounts& counts : postures(pen, 100, 36)) {
    EncoderCounts wrong = counts;
    wrong[3] += 400;
    diagnosis.add(pen.posture(wrong));
  }
  for (const EncoderCounts& counts : postures(pen, 500, 37)) diagnosis.add(pen.posture(counts));
  EXPECT_EQ(diagnosis.postures(), 64U);
  EXPECT_EQ(diagnosis.verdict().fault, GripFault::None);
  diagnosis.clear();
  EXPECT_EQ(diagnosis.postures(), 0U);
}

}  // namespace
}  // namespace riffler::pen::redundancy_test
