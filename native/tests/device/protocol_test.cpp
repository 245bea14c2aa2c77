// The codec of the pen's reports.
#include "device/protocol/pen_protocol.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "device/fields.hpp"
#include "device/pens.hpp"

namespace riffler::device::protocol_test {
namespace {

template <class T>
void expect_round_trips(T (*make)(stress::Random&), std::uint64_t seed) {
  stress::Random random(seed);
  for (int round = 0; round < 20'000; ++round) {
    const T report = make(random);
    const Bytes bytes = encoded(report);
    T back{};
    ASSERT_EQ(decode(bytes, back), RIFFLER_PEN_OK);
    ASSERT_EQ(encoded(back), bytes);
  }
}

TEST(PenProtocol, EveryReportWithinItsBoundsRoundTrips) {
  expect_round_trips<riffler_pen_input>(random_input, 1);
  expect_round_trips<riffler_pen_output>(random_output, 2);
  expect_round_trips<riffler_pen_identity>(random_identity, 3);
  expect_round_trips<riffler_pen_limits>(random_limits, 4);
}

TEST(PenProtocol, AnInputReportHasTheseBytes) {
  riffler_pen_input report{};
  report.state = RIFFLER_PEN_FAULT;
  report.sequence = 0x1234;
  report.time_us = 0x89ABCDEF;
  const std::int32_t counters[] = {0, 1, -1, INT32_MAX, INT32_MIN, -5133};
  for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) report.counters[k] = counters[k];
  report.probe = 0x01020304;
  report.buttons = 0x8001;
  report.flags = RIFFLER_PEN_FLAG_HOST | RIFFLER_PEN_FLAG_BRAKE;
  report.fault = RIFFLER_PEN_ENCODER_JUMP;
  report.fault_joint = 4;
  report.fault_count = 255;
  report.refused_count = 7;
  report.echo_sequence = 0xFFFE;
  const std::int16_t applied[] = {0, 1, -1, INT16_MAX, INT16_MIN, -300};
  for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) report.applied[k] = applied[k];
  report.echo_time_us = 0xFFFFFFFF;
  const Bytes golden = {0x01, 0x04, 0x34, 0x12, 0xEF, 0xCD, 0xAB, 0x89,  // number, state, sequence, time
                        0x00, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0xFF, 0xFF, 0xFF, 0xFF,
                        0xFF, 0xFF, 0xFF, 0x7F, 0x00, 0x00, 0x00, 0x80, 0xF3, 0xEB, 0xFF, 0xFF,  // counters
                        0x04, 0x03, 0x02, 0x01, 0x01, 0x80, 0x41, 0x00,  // probe, buttons, flags
                        0x0A, 0x04, 0xFF, 0x07, 0xFE, 0xFF,              // fault, echo
                        0x00, 0x00, 0x01, 0x00, 0xFF, 0xFF, 0xFF, 0x7F, 0x00, 0x80, 0xD4, 0xFE,  // applied
                        0xFF, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(encoded(report), golden);
  riffler_pen_input back{};
  ASSERT_EQ(decode(golden, back), RIFFLER_PEN_OK);
  EXPECT_EQ(back.counters[4], INT32_MIN);
  EXPECT_EQ(back.counters[5], -5133);
  EXPECT_EQ(back.applied[4], INT16_MIN);
  EXPECT_EQ(back.applied[5], -300);
  EXPECT_EQ(back.time_us, 0x89ABCDEFU);
}

TEST(PenProtocol, AnOutputReportHasTheseBytes) {
  riffler_pen_output report{};
  report.enable = 1;
  report.sequence = 0xFFFF;
  report.time_us = 1'000'000;
  const std::int16_t commands[] = {1500, -1500, 0, 256, -256, 1};
  for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) report.commands[k] = commands[k];
  const Bytes golden = {0x02, 0x01, 0xFF, 0xFF, 0x40, 0x42, 0x0F, 0x00, 0xDC, 0x05,
                        0x24, 0xFA, 0x00, 0x00, 0x00, 0x01, 0x00, 0xFF, 0x01, 0x00};
  EXPECT_EQ(encoded(report), golden);
}

TEST(PenProtocol, AnIdentityReportHasTheseBytes) {
  riffler_pen_identity report{};
  report.major = 1;
  report.minor = 2;
  report.firmware = 0x0304;
  std::copy_n("reference", 10, report.geometry);
  std::copy_n("0123456789ABCDEF", 17, report.serial);
  Bytes golden = {0x03, 'R', 'P', 'e', 'n', 0x01, 0x02, 0x00, 0x04, 0x03};
  for (const char c : std::string("reference")) golden.push_back(static_cast<std::uint8_t>(c));
  golden.resize(34, 0);
  for (const char c : std::string("0123456789ABCDEF")) golden.push_back(static_cast<std::uint8_t>(c));
  EXPECT_EQ(encoded(report), golden);
  riffler_pen_identity back{};
  ASSERT_EQ(decode(golden, back), RIFFLER_PEN_OK);
  EXPECT_STREQ(back.geometry, "reference");
  EXPECT_STREQ(back.serial, "0123456789ABCDEF") << "a name that fills its field ends behind it";
}

TEST(PenProtocol, ALimitsReportHasTheseBytes) {
  const Bytes golden = {
      0x04, 0x00, 0xDC, 0x05, 0xDC, 0x05, 0xDC, 0x05, 0xDC, 0x05, 0xDC, 0x05, 0xDC, 0x05, 0xF4,
      0x01, 0xF4, 0x01, 0xF4, 0x01, 0xF4, 0x01, 0xF4, 0x01, 0xF4, 0x01, 0x64, 0x00, 0x10, 0x27,  // 100 mA/ms, 10 s
      0xE8, 0x03, 0x00, 0x00, 0x88, 0x13, 0x00, 0x00,                                            // 1 ms, 5 ms
      0x20, 0x4E, 0x00, 0x00, 0x20, 0xA1, 0x07, 0x00,                                            // 20 ms, 0.5 s
      0x80, 0x1A, 0x06, 0x00, 0x90, 0x01, 0xD0, 0x07};
  EXPECT_EQ(encoded(reference().limits), golden);
}

/// The bytes that differ when one field goes from all zeros to all ones.
template <class T>
std::set<std::size_t> bytes_of(const std::function<void(T&)>& fill) {
  T zero{}, full{};
  fill(full);
  const Bytes a = encoded(zero), b = encoded(full);
  std::set<std::size_t> differ;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k] != b[k]) differ.insert(k);
  return differ;
}

void expect_at(const std::string& report, const std::string& name, const std::set<std::size_t>& bytes) {
  for (const Report& r : reports())
    for (const Field& f : r.fields)
      if (r.name == report && f.name == name) {
        std::set<std::size_t> expected;
        for (std::size_t k = 0; k < f.size(); ++k) expected.insert(f.offset + k);
        EXPECT_EQ(bytes, expected) << report << " " << name;
        return;
      }
  FAIL() << report << " has no field " << name;
}

TEST(PenProtocol, EveryFieldWritesItsOwnBytesAndNoOthers) {
  using In = riffler_pen_input;
  const auto ones = [](auto& array) {
    for (auto& value : array) value = static_cast<std::remove_reference_t<decltype(value)>>(-1);
  };
  expect_at("Input", "sequence", bytes_of<In>([](In& r) { r.sequence = 0xFFFF; }));
  expect_at("Input", "time_us", bytes_of<In>([](In& r) { r.time_us = 0xFFFFFFFF; }));
  expect_at("Input", "counters", bytes_of<In>([&](In& r) { ones(r.counters); }));
  expect_at("Input", "probe", bytes_of<In>([](In& r) { r.probe = -1; }));
  expect_at("Input", "buttons", bytes_of<In>([](In& r) { r.buttons = 0xFFFF; }));
  expect_at("Input", "flags", bytes_of<In>([](In& r) { r.flags = 0xFFFF; }));
  expect_at("Input", "state", bytes_of<In>([](In& r) { r.state = RIFFLER_PEN_FAULT; }));
  expect_at("Input", "fault", bytes_of<In>([](In& r) { r.fault = 0xFF; }));
  expect_at("Input", "fault_joint", bytes_of<In>([](In& r) { r.fault_joint = 0xFF; }));
  expect_at("Input", "fault_count", bytes_of<In>([](In& r) { r.fault_count = 0xFF; }));
  expect_at("Input", "refused_count", bytes_of<In>([](In& r) { r.refused_count = 0xFF; }));
  expect_at("Input", "echo_sequence", bytes_of<In>([](In& r) { r.echo_sequence = 0xFFFF; }));
  expect_at("Input", "applied", bytes_of<In>([&](In& r) { ones(r.applied); }));
  expect_at("Input", "echo_time_us", bytes_of<In>([](In& r) { r.echo_time_us = 0xFFFFFFFF; }));
  using Out = riffler_pen_output;
  expect_at("Output", "flags", bytes_of<Out>([](Out& r) { r.enable = 1; }));
  expect_at("Output", "sequence", bytes_of<Out>([](Out& r) { r.sequence = 0xFFFF; }));
  expect_at("Output", "time_us", bytes_of<Out>([](Out& r) { r.time_us = 0xFFFFFFFF; }));
  expect_at("Output", "commands", bytes_of<Out>([&](Out& r) { ones(r.commands); }));
  using Who = riffler_pen_identity;
  expect_at("Identity", "major", bytes_of<Who>([](Who& r) { r.major = 0xFF; }));
  expect_at("Identity", "minor", bytes_of<Who>([](Who& r) { r.minor = 0xFF; }));
  expect_at("Identity", "firmware", bytes_of<Who>([](Who& r) { r.firmware = 0xFFFF; }));
  expect_at("Identity", "geometry", bytes_of<Who>([&](Who& r) { ones(r.geometry); }));
  expect_at("Identity", "serial", bytes_of<Who>([&](Who& r) { ones(r.serial); }));
  using Lim = riffler_pen_limits;
  expect_at("Limits", "peak_ma", bytes_of<Lim>([&](Lim& r) { ones(r.peak_ma); }));
  expect_at("Limits", "continuous_ma", bytes_of<Lim>([&](Lim& r) { ones(r.continuous_ma); }));
  expect_at("Limits", "rate_ma_per_ms", bytes_of<Lim>([](Lim& r) { r.rate_ma_per_ms = 0xFFFF; }));
  expect_at("Limits", "thermal_ms", bytes_of<Lim>([](Lim& r) { r.thermal_ms = 0xFFFF; }));
  expect_at("Limits", "period_us", bytes_of<Lim>([](Lim& r) { r.period_us = 0xFFFFFFFF; }));
  expect_at("Limits", "stale_us", bytes_of<Lim>([](Lim& r) { r.stale_us = 0xFFFFFFFF; }));
  expect_at("Limits", "watchdog_us", bytes_of<Lim>([](Lim& r) { r.watchdog_us = 0xFFFFFFFF; }));
  expect_at("Limits", "ramp_us", bytes_of<Lim>([](Lim& r) { r.ramp_us = 0xFFFFFFFF; }));
  expect_at("Limits", "speed_counts_per_s", bytes_of<Lim>([](Lim& r) { r.speed_counts_per_s = 0xFFFFFFFF; }));
  expect_at("Limits", "stall_ma", bytes_of<Lim>([](Lim& r) { r.stall_ma = 0xFFFF; }));
  expect_at("Limits", "stall_ms", bytes_of<Lim>([](Lim& r) { r.stall_ms = 0xFFFF; }));
}

TEST(PenProtocol, TheFieldsFillEveryReportWithoutGapOrOverlap) {
  for (const Report& report : reports()) {
    std::size_t next = 1;
    for (const Field& field : report.fields) {
      EXPECT_EQ(field.offset, next) << report.name << " " << field.name;
      next += field.size();
    }
    EXPECT_EQ(next, report.size) << report.name;
    EXPECT_LE(report.size, std::size_t{RIFFLER_PEN_PACKET_SIZE}) << report.name;
  }
}

/// The result for a valid report with one byte changed.
template <class T>
riffler_pen_result with(const T& report, std::size_t at, int byte) {
  Bytes bytes = encoded(report);
  bytes.at(at) = static_cast<std::uint8_t>(byte);
  T back{};
  return decode(bytes, back);
}

TEST(PenProtocol, AStateThatDoesNotExistOrFitTheFaultIsRefused) {
  riffler_pen_input report{};
  report.fault_joint = RIFFLER_PEN_NO_JOINT;
  for (int state = 0; state < 256; ++state)
    EXPECT_EQ(with(report, RIFFLER_PEN_INPUT_STATE, state), state < 4 ? RIFFLER_PEN_OK : RIFFLER_PEN_BAD_STATE);
  EXPECT_EQ(with(report, RIFFLER_PEN_INPUT_FAULT, 1), RIFFLER_PEN_BAD_STATE) << "a fault outside its state";
  EXPECT_EQ(with(report, RIFFLER_PEN_INPUT_FAULT_JOINT, 0), RIFFLER_PEN_BAD_STATE) << "a joint without a fault";
  report.state = RIFFLER_PEN_FAULT;
  for (int fault = 0; fault < 256; ++fault)
    EXPECT_EQ(with(report, RIFFLER_PEN_INPUT_FAULT, fault), fault ? RIFFLER_PEN_OK : RIFFLER_PEN_BAD_STATE)
        << "later minor versions may have more faults";
  report.fault = RIFFLER_PEN_STALL;
  for (int joint = 0; joint < 256; ++joint)
    EXPECT_EQ(with(report, RIFFLER_PEN_INPUT_FAULT_JOINT, joint),
              joint < 6 || joint == 255 ? RIFFLER_PEN_OK : RIFFLER_PEN_BAD_STATE);
}

TEST(PenProtocol, AFlagOfAnOutputReportThatHasNoMeaningIsRefused) {
  for (int flags = 0; flags < 256; ++flags)
    EXPECT_EQ(with(riffler_pen_output{}, RIFFLER_PEN_OUTPUT_FLAGS, flags),
              flags < 2 ? RIFFLER_PEN_OK : RIFFLER_PEN_BAD_FLAGS);
}

TEST(PenProtocol, AnotherLengthOrNumberIsRefused) {
  stress::Random random(5);
  const std::vector<Bytes> valid = {encoded(random_input(random)), encoded(random_output(random)),
                                    encoded(random_identity(random)), encoded(random_limits(random))};
  const auto result = [](std::size_t kind, const Bytes& bytes) {
    riffler_pen_input input;
    riffler_pen_output output;
    riffler_pen_identity identity;
    riffler_pen_limits limits;
    return kind == 0   ? decode(bytes, input)
           : kind == 1 ? decode(bytes, output)
           : kind == 2 ? decode(bytes, identity)
                       : decode(bytes, limits);
  };
  for (std::size_t kind = 0; kind < valid.size(); ++kind) {
    for (std::size_t size = 0; size <= 70; ++size) {
      Bytes bytes = valid[kind];
      bytes.resize(size);
      bytes.shrink_to_fit();
      EXPECT_EQ(result(kind, bytes), size == valid[kind].size() ? RIFFLER_PEN_OK : RIFFLER_PEN_WRONG_LENGTH);
    }
    for (int id = 0; id < 256; ++id) {
      Bytes bytes = valid[kind];
      bytes[0] = static_cast<std::uint8_t>(id);
      EXPECT_EQ(result(kind, bytes), id == reports()[kind].id ? RIFFLER_PEN_OK : RIFFLER_PEN_WRONG_ID);
    }
  }
}

TEST(PenProtocol, APenOfAnotherVersionIsRecognisedFromAnyReport) {
  stress::Random random(6);
  for (int major = 0; major < 256; ++major) {
    if (major == RIFFLER_PEN_PROTOCOL_MAJOR) continue;
    Bytes bytes = encoded(random_identity(random));
    bytes[RIFFLER_PEN_IDENTITY_MAJOR] = static_cast<std::uint8_t>(major);
    bytes[RIFFLER_PEN_IDENTITY_MINOR] = 9;
    bytes.resize(7 + static_cast<std::size_t>(random.below(100)), 0xFF);
    riffler_pen_identity identity{};
    ASSERT_EQ(decode(bytes, identity), RIFFLER_PEN_OTHER_VERSION);
    EXPECT_EQ(identity.major, major);
    EXPECT_EQ(identity.minor, 9);
  }
}

TEST(PenProtocol, ADeviceThatOnlySharesThePensNumberIsRefused) {
  const riffler_pen_identity identity = reference().identity;
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(with(identity, RIFFLER_PEN_IDENTITY_MAGIC + k, 'x'), RIFFLER_PEN_NOT_A_PEN);
  EXPECT_EQ(with(identity, RIFFLER_PEN_IDENTITY_RESERVED, 1), RIFFLER_PEN_BAD_RESERVED);
}

TEST(PenProtocol, ANameIsGraphicAsciiAndThenNothing) {
  const riffler_pen_identity identity = reference().identity;  // "riffler", "0"
  const std::size_t geometry = RIFFLER_PEN_IDENTITY_GEOMETRY, serial = RIFFLER_PEN_IDENTITY_SERIAL;
  EXPECT_EQ(with(identity, geometry, 0), RIFFLER_PEN_BAD_NAME) << "empty, then letters";
  EXPECT_EQ(with(identity, serial, 0), RIFFLER_PEN_BAD_NAME) << "empty";
  for (int c = 1; c < 256; ++c)
    EXPECT_EQ(with(identity, geometry + 3, c), c > 0x20 && c < 0x7F ? RIFFLER_PEN_OK : RIFFLER_PEN_BAD_NAME) << c;
  EXPECT_EQ(with(identity, geometry + 3, 0), RIFFLER_PEN_BAD_NAME) << "letters after the end";
  EXPECT_EQ(with(identity, serial + 15, 'x'), RIFFLER_PEN_BAD_NAME) << "a letter at the far end";
}

TEST(PenProtocol, LimitsOutOfTheirRangesAreRefusedWithWhatIsWrong) {
  const riffler_pen_limits good = reference().limits;
  ASSERT_EQ(riffler_pen_limits_problem(&good), nullptr);
  const auto expect = [&](const char* what, const std::function<void(riffler_pen_limits&)>& spoil) {
    riffler_pen_limits limits = good;
    spoil(limits);
    const char* const problem = riffler_pen_limits_problem(&limits);
    ASSERT_NE(problem, nullptr) << what;
    EXPECT_NE(std::string(problem).find(what), std::string::npos) << problem;
    riffler_pen_limits back{};
    EXPECT_EQ(decode(encoded(limits), back), RIFFLER_PEN_BAD_LIMITS);
    EXPECT_EQ(back.peak_ma[0], 0) << "nothing written";
  };
  expect("peak", [](auto& l) { l.peak_ma[5] = 0; });
  expect("peak", [](auto& l) { l.peak_ma[2] = 32768; });
  expect("continuous", [](auto& l) { l.continuous_ma[0] = 0; });
  expect("continuous", [](auto& l) { l.continuous_ma[3] = 1501; });
  expect("rate", [](auto& l) { l.rate_ma_per_ms = 0; });
  expect("thermal", [](auto& l) { l.thermal_ms = 0; });
  expect("period", [](auto& l) { l.period_us = 124; });
  expect("period", [](auto& l) { l.period_us = 100'001; });
  expect("watchdog", [](auto& l) { l.watchdog_us = 1'000'001; });
  expect("watchdog", [](auto& l) { l.watchdog_us = 1000; });
  expect("stale", [](auto& l) { l.stale_us = 999; });
  expect("stale", [](auto& l) { l.stale_us = 20'000; });
  expect("ramp", [](auto& l) { l.ramp_us = 0; });
  expect("ramp", [](auto& l) { l.ramp_us = 60'000'001; });
  expect("speed", [](auto& l) { l.speed_counts_per_s = 0; });
  expect("speed", [](auto& l) { l.speed_counts_per_s = 100'000'001; });
  expect("stall", [](auto& l) { l.stall_ma = 0; });
  expect("stall", [](auto& l) { l.stall_ms = 0; });
  expect("stall", [](auto& l) { l.stall_ma = 501; });
  Bytes bytes = encoded(good);
  bytes[RIFFLER_PEN_LIMITS_RESERVED] = 1;
  riffler_pen_limits back{};
  EXPECT_EQ(decode(bytes, back), RIFFLER_PEN_BAD_RESERVED);
}

TEST(PenProtocol, SequenceNumbersAreComparedAcrossTheirWrap) {
  EXPECT_TRUE(riffler_pen_is_newer(1, 0));
  EXPECT_FALSE(riffler_pen_is_newer(0, 0));
  EXPECT_FALSE(riffler_pen_is_newer(0, 1));
  EXPECT_TRUE(riffler_pen_is_newer(0, 0xFFFF));
  EXPECT_TRUE(riffler_pen_is_newer(5, 0xFFF0));
  EXPECT_TRUE(riffler_pen_is_newer(0x7FFF, 0));
  EXPECT_FALSE(riffler_pen_is_newer(0x8000, 0)) << "half way round is neither";
  EXPECT_FALSE(riffler_pen_is_newer(0, 0x8000));
  for (std::uint32_t a = 0; a < 65536; a += 251)
    for (std::uint32_t b = 0; b < 65536; b += 257) {
      const auto x = static_cast<std::uint16_t>(a), y = static_cast<std::uint16_t>(b);
      ASSERT_LE(riffler_pen_is_newer(x, y) + riffler_pen_is_newer(y, x), 1);
    }
}

TEST(PenProtocol, CountersAreSubtractedAcrossTheirWrap) {
  EXPECT_EQ(riffler_pen_counts_between(5, 3), 2);
  EXPECT_EQ(riffler_pen_counts_between(INT32_MIN, INT32_MAX), 1);
  EXPECT_EQ(riffler_pen_counts_between(INT32_MAX, INT32_MIN), -1);
  EXPECT_EQ(riffler_pen_counts_between(0, INT32_MIN), INT32_MIN);
}

TEST(PenProtocol, EveryNumberHasWords) {
  std::set<std::string> texts;
  for (unsigned k = 0; k < RIFFLER_PEN_STATES; ++k) texts.insert(riffler_pen_state_text(k));
  for (unsigned k = 0; k < RIFFLER_PEN_FAULTS; ++k) texts.insert(riffler_pen_fault_text(k));
  for (unsigned k = 0; k < RIFFLER_PEN_RESULTS; ++k) texts.insert(riffler_pen_result_text(k));
  EXPECT_EQ(texts.size(), std::size_t{RIFFLER_PEN_STATES} + RIFFLER_PEN_FAULTS + RIFFLER_PEN_RESULTS);
  EXPECT_STREQ(riffler_pen_state_text(RIFFLER_PEN_STATES), "unknown state");
  EXPECT_STREQ(riffler_pen_fault_text(RIFFLER_PEN_FAULTS), "unknown fault");
  EXPECT_STREQ(riffler_pen_result_text(RIFFLER_PEN_RESULTS), "unknown result");
}

}  // namespace
}  // namespace riffler::device::protocol_test
