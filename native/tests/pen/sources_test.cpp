// What is a device without a cable: recordings, tablets, mice; and what is known of devices before they are opened.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geom/math.hpp"
#include "pen/hid/hid_descriptor.hpp"
#include "pen/hid/hid_handle.hpp"
#include "riffler/pen/hid/hid_list.hpp"
#include "riffler/pen/playback.hpp"
#include "riffler/pen/pointer.hpp"
#include "stress/random.hpp"
#include "support/error_of.hpp"
#include "support/hid_devices.hpp"

namespace riffler::pen::sources_test {
namespace {

using test::error_of;

std::vector<RecordedStroke> two_strokes() {
  return {{{{{0, 0, 0}, {0, 0, 1}}, {{10, 0, 0}, {1, 0, 0}}}, {5, 6}},
          {{{{0, 5, 0}, {0, 0, 1}}, {{0, 9, 0}, {0, 0, 1}}}, {8, 9}}};
}

TEST(Playback, GoesAtThePaceOfTheRecording) {
  double now = 50;
  PlaybackPen pen(two_strokes(), 1, [&] { return now; });
  EXPECT_EQ(pen.newest().pose.tip, Vec3(0));
  now = 50.5;
  PenSample sample = pen.newest();
  EXPECT_LT(glm::length(sample.pose.tip - Vec3(5, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(sample.pose.axis - std::sqrt(0.5) * Vec3(1, 0, 1)), 1e-12);
  EXPECT_LT(glm::length(sample.velocity - Vec3(10, 0, 0)), 1e-12);
  EXPECT_NEAR(glm::length(sample.turning), kPi / 2, 1e-12);
  EXPECT_EQ(sample.buttons, 1U);
  EXPECT_EQ(pen.age(), 0);
  now = 52;  // between the strokes
  sample = pen.newest();
  EXPECT_EQ(sample.buttons, 0U);
  EXPECT_EQ(sample.pose.tip, Vec3(10, 0, 0));
  now = 53.25;
  EXPECT_LT(glm::length(pen.newest().pose.tip - Vec3(0, 6, 0)), 1e-12);
  EXPECT_EQ(pen.status().state, LinkState::Connected);
  now = 1000;
  EXPECT_EQ(pen.newest().pose.tip, Vec3(0, 9, 0));
  EXPECT_EQ(pen.newest().sequence, 4U);
  EXPECT_EQ(pen.status().state, LinkState::Stopped);
}

TEST(Playback, PlaysFasterAndTakesStrokesThatOverlapInTime) {
  auto strokes = two_strokes();
  strokes[1].times = {0, 1};  // of another clock
  double now = 0;
  PlaybackPen pen(strokes, 2, [&] { return now; });
  EXPECT_NEAR(pen.duration(), 1, 1e-12);
  pen.newest();
  now = 0.75;
  EXPECT_LT(glm::length(pen.newest().pose.tip - Vec3(0, 7, 0)), 1e-12);
  EXPECT_NEAR(pen.newest().velocity.y, 8, 1e-12);
}

TEST(Playback, ForceIsIgnoredWithTheReason) {
  PlaybackPen pen(two_strokes());
  const PushAnswer answer = pen.push({{1, 0, 0}, {}});
  EXPECT_EQ(answer.reason, NotPushed::NoMotors);
  EXPECT_EQ(answer.missing.force, Vec3(1, 0, 0));
  EXPECT_EQ(pen.push({{NAN, 0, 0}, {}}).reason, NotPushed::BadWrench);
  EXPECT_EQ(pen.push({}).reason, NotPushed::None);
}

TEST(Playback, WrongRecordingsNameStrokeAndRow) {
  const auto error = [](const std::function<void(std::vector<RecordedStroke>&)>& spoil) {
    auto strokes = two_strokes();
    spoil(strokes);
    return error_of([&] { PlaybackPen{strokes}; });
  };
  EXPECT_EQ(error([](auto& s) { s[1].times = {9, 8}; }), "stroke 1, row 1: times fall");
  EXPECT_EQ(error([](auto& s) { s[1].times.pop_back(); }), "stroke 1, row 1: a recording needs one time for each pose");
  EXPECT_EQ(error([](auto& s) { s[0].times[0] = NAN; }), "stroke 0, row 0: a time is not finite");
  EXPECT_EQ(error([](auto& s) { s[0].poses[1].axis = {0, 0, -1}; }),
            "stroke 0, row 1: the axis is opposite to the one before");
  EXPECT_EQ(error([](auto& s) { s[0].poses.clear(); }), "stroke 0, row 0: a stroke needs a pose");
  EXPECT_EQ(error([](auto& s) { s.clear(); }), "strokes: a recording needs a stroke");
  EXPECT_EQ(error_of([] { PlaybackPen(two_strokes(), 0); }), "speed must be positive");
}

TEST(Playback, AStrokeOfOnePoseAndEqualTimesArePlayed) {
  double now = 0;
  PlaybackPen pen({{{{{1, 2, 3}, {0, 0, 1}}}, {7}}, {{{{4, 5, 6}, {0, 0, 1}}, {{7, 8, 9}, {0, 0, 1}}}, {7, 7}}}, 1,
                  [&] { return now; });
  EXPECT_EQ(pen.newest().pose.tip, Vec3(7, 8, 9));
  EXPECT_EQ(pen.status().state, LinkState::Stopped);
}

TEST(Pointer, MapsPlanePressureAndTilt) {
  PointerFrame frame;
  frame.origin = {1, 2, 3}, frame.right = {0, 1, 0}, frame.up = {0, 0, 1};  // right × up = x
  frame.scale = 0.5, frame.depth = 4;
  PointerPen pen(PointerPen::Kind::Tablet, frame);
  EXPECT_TRUE(std::isinf(pen.age()));
  PointerEvent event;
  event.x = 10, event.y = -20, event.pressure = 0.25, event.tilt_x = 0.5, event.buttons = 5, event.time = 1;
  EXPECT_TRUE(pen.give(event));
  PenSample sample = pen.newest();
  EXPECT_LT(glm::length(sample.pose.tip - Vec3(0, 7, -7)), 1e-12);
  EXPECT_LT(glm::length(sample.pose.axis - Vec3(std::cos(0.5), std::sin(0.5), 0)), 1e-12);
  EXPECT_EQ(sample.buttons, 5U);
  event.x = 20, event.time = 1.5;
  EXPECT_TRUE(pen.give(event));
  EXPECT_LT(glm::length(pen.newest().velocity - Vec3(0, 10, 0)), 1e-12);
  EXPECT_EQ(pen.newest().sequence, 2U);
}

TEST(Pointer, TiltsAreHeldFromTheHorizon) {
  const PointerFrame frame;
  stress::Random random(2);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 axis = tilted_axis(frame, 8 * random.uniform() - 4, 8 * random.uniform() - 4);
    EXPECT_NEAR(glm::length(axis), 1, 1e-12);
    EXPECT_GE(axis.z, std::cos(frame.max_tilt) - 1e-12);
  }
  EXPECT_EQ(tilted_axis(frame, NAN, NAN), Vec3(0, 0, 1));
  EXPECT_EQ(tilted_axis(frame, 0, 0), Vec3(0, 0, 1));
}

TEST(Pointer, AMouseStandsUprightAndImpossibleEventsAreSkipped) {
  PointerPen pen(PointerPen::Kind::Mouse);
  PointerEvent event;
  event.tilt_x = 1, event.pressure = 7, event.time = 2;
  EXPECT_TRUE(pen.give(event));
  EXPECT_EQ(pen.newest().pose.axis, Vec3(0, 0, 1));
  EXPECT_EQ(pen.newest().pose.tip.z, -2) << "pressure is at most full";
  event.time = 1;
  EXPECT_FALSE(pen.give(event));
  event.time = 3, event.x = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(pen.give(event));
  EXPECT_EQ(pen.newest().sequence, 1U);
  EXPECT_EQ(pen.push({{0, 0, 1}, {}}).reason, NotPushed::NoMotors);
}

TEST(Pointer, WrongFramesNameTheField) {
  PointerFrame frame;
  frame.up = {1, 0, 0};
  EXPECT_NE(error_of([&] { frame.validate(); }).find("right and up"), std::string::npos);
  frame = {}, frame.scale = 0;
  EXPECT_NE(error_of([&] { frame.validate(); }).find("scale"), std::string::npos);
  frame = {}, frame.max_tilt = 2;
  EXPECT_NE(error_of([&] { frame.validate(); }).find("max_tilt"), std::string::npos);
}

TEST(HidDescriptor, GivesTheSizesOfOurReports) {
  const HidReports reports = parse_descriptor(test::pen_descriptor());
  EXPECT_TRUE(reports.numbered);
  EXPECT_EQ(1 + reports.input[RIFFLER_PEN_INPUT_ID], RIFFLER_PEN_INPUT_SIZE);
  EXPECT_EQ(1 + reports.output[RIFFLER_PEN_OUTPUT_ID], RIFFLER_PEN_OUTPUT_SIZE);
  EXPECT_EQ(1 + reports.feature[RIFFLER_PEN_IDENTITY_ID], RIFFLER_PEN_IDENTITY_SIZE);
  EXPECT_EQ(1 + reports.feature[RIFFLER_PEN_LIMITS_ID], RIFFLER_PEN_LIMITS_SIZE);
  EXPECT_TRUE(reports.has_usage(RIFFLER_PEN_USAGE_PAGE, RIFFLER_PEN_USAGE));
}

TEST(HidDescriptor, GivesTheSizesOfOthers) {
  const HidReports split = parse_descriptor(test::puck_descriptor(false)),
                   joined = parse_descriptor(test::puck_descriptor(true));
  EXPECT_EQ(split.input[1], 6);
  EXPECT_EQ(split.input[2], 6);
  EXPECT_EQ(split.input[3], 2);
  EXPECT_EQ(joined.input[1], 12);
  EXPECT_EQ(joined.input[2], 0);
  const HidReports teensy = parse_descriptor(test::teensy_descriptor());
  EXPECT_FALSE(teensy.numbered);
  EXPECT_EQ(teensy.input[0], 64);
  EXPECT_EQ(teensy.output[0], 64);
  EXPECT_TRUE(teensy.has_usage(0xFFAB, 0x0200));
}

TEST(HidDescriptor, ErrorsNameTheByte) {
  EXPECT_EQ(error_of([] { parse_descriptor(test::Bytes{0x05, 0x01, 0x26, 0xFF}); }),
            "report descriptor, byte 2: ends within an item");
  EXPECT_NE(error_of([] { parse_descriptor(test::Bytes{0xC0}); }), "");
  EXPECT_NE(error_of([] { parse_descriptor(test::Bytes{0xB4}); }), "");
  EXPECT_NE(error_of([] { parse_descriptor(test::Bytes{0x85, 0}); }), "");
  EXPECT_NE(error_of([] { parse_descriptor(test::Bytes{0xFE}); }), "");
  EXPECT_NE(error_of([] {
              parse_descriptor(test::Bytes{0x77, 0xFF, 0xFF, 0xFF, 0xFF, 0x97, 0xFF, 0xFF, 0xFF, 0xFF, 0x81, 2});
            }),
            "");
  // Any bytes are an answer or an error, and never read beyond the end.
  stress::Random random(9);
  for (int k = 0; k < 20000; ++k) {
    test::Bytes bytes(static_cast<std::size_t>(random.uniform() * 40));
    for (auto& b : bytes) b = static_cast<std::uint8_t>(random.uniform() * 256);
    error_of([&] { parse_descriptor(bytes); });
  }
}

TEST(HidList, ADeviceIsFoundAgainByItsLastingNumbers) {
  HidInfo a = test::pen_info(), b = test::pen_info(), c = test::puck_info();
  a.serial = "1", b.serial = "2", b.path = "/dev/hidraw5";
  const HidAddress address = HidAddress::of(a);
  a.path = "/dev/hidraw9";
  EXPECT_EQ(find_again({c, b, a}, address)->path, "/dev/hidraw9");
  EXPECT_EQ(find_again({c, b}, address), nullptr);
  // Two without serial numbers: the one at the same path.
  HidInfo d = c;
  d.path = "/dev/hidraw2";
  EXPECT_EQ(find_again({c, d}, HidAddress::of(d))->path, "/dev/hidraw2");
}

TEST(HidList, TheRuleNamesTheProductWhereItMay) {
  HidInfo info = test::pen_info();
  EXPECT_EQ(udev_rule(info),
            R"(ACTION!="remove", SUBSYSTEM=="hidraw", ATTRS{idVendor}=="1209", ATTRS{idProduct}=="0001", )"
            R"(ATTRS{product}=="Riffler pen", TAG+="uaccess")");
  for (const char* name : {"", "a*", "\"", "Mäuschen", "[x]"}) {
    info.name = name;
    EXPECT_EQ(udev_rule(info).find("ATTRS{product}"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace riffler::pen::sources_test
