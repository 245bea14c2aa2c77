// Positions of the machine and work offsets: which moves lie in the part, and what is reported where that is unknown.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "nc/machine/machines.hpp"
#include "riffler/nc/edit.hpp"
#include "riffler/nc/program_file.hpp"
#include "riffler/nc/write/writer.hpp"
#include "support/nc_reading.hpp"

namespace riffler::nc::machine_position_test {
namespace {

using test::nc_error;
using test::read_nc_text;
using Numbers = std::vector<double>;

const Options kTable{{"rot_point", Numbers{0, 0, -50}}};

Options own_options(const std::string& machine) {
  return machine.starts_with("linuxcnc") ? kTable : Options{};
}

/// Without the blocks that bring a tool to its first row.
WriteOptions for_machine(const std::string& name) {
  WriteOptions out;
  out.post = name, out.options = own_options(name);
  out.options["safe_start"] = false;
  return out;
}

struct Row {
  Vec3 tip;
  bool away;
  bool operator==(const Row&) const = default;
};

std::vector<Row> rows(const Program& program) {
  std::vector<Row> out;
  for (std::size_t k = 0; k < program.size(); ++k)
    out.push_back({program.poses()[k].tip, program.at_machine()[k] != 0});
  return out;
}
std::vector<Row> rows(const std::string& text, const Options& options = {}, const std::string& machine = "tcp") {
  return rows(read_nc_text("G21\n" + text, machine, options));
}

std::vector<std::string> kinds(const std::string& text, const Options& options = {},
                               const std::string& machine = "tcp") {
  std::vector<std::string> out;
  for (const Note& n : read_nc_text("G21\n" + text, machine, options).notes) out.push_back(n.kind);
  return out;
}
using Kinds = std::vector<std::string>;

/// The frame that Fusion, Fanuc and Haas put around every program.
const std::string kFramed =
    "G28 G91 Z0\nG90\nT1 M6\nS5000 M3\nG54\nG0 X10 Y20\nG43 Z15 H1\nG1 Z-1 F300\nX30\nG0 Z15\nG28 G91 Z0\nG28 X0 Y0\n"
    "M30\n";

TEST(MachinePositions, AreNotPositionsOnThePart) {
  // The first move whose place is known is the first row; what follows it goes nowhere in the part.
  EXPECT_EQ(rows(kFramed), (std::vector<Row>{{{10, 20, 15}, false},
                                             {{10, 20, -1}, false},
                                             {{30, 20, -1}, false},
                                             {{30, 20, 15}, false},
                                             {{30, 20, 15}, false},  // G28's intermediate point: where it is
                                             {{30, 20, 15}, true},
                                             {{30, 20, 15}, true},
                                             {{30, 20, 15}, true}}));
  EXPECT_EQ(kinds(kFramed), Kinds{"machine position"});
  for (const char* home : {"G53 G0 Z0", "G91 G30 Z0\nG90", "G28", "G53 G0 X-10 Y-10 Z0"})
    EXPECT_EQ(rows("G0 X1 Y2 Z3\n" + std::string(home)).back(), (Row{{1, 2, 3}, true})) << home;
}

TEST(MachinePositions, EndOnceEveryAxisHasACoordinateAgain) {
  const std::string there = "G0 X1 Y2 Z3\nG53 G0 Z0\n";
  EXPECT_EQ(rows(there + "X5\nY6\nZ7\nX8"), (std::vector<Row>{{{1, 2, 3}, false},
                                                              {{1, 2, 3}, true},
                                                              {{1, 2, 3}, true},
                                                              {{1, 2, 3}, true},
                                                              {{5, 6, 7}, false},
                                                              {{8, 6, 7}, false}}));
  EXPECT_EQ(rows(there + "G91 Z-5\nG90 Z4").back(), (Row{{1, 2, 4}, false}));
  // The intermediate point before a home is one of the part.
  EXPECT_EQ(rows("G0 X1 Y2 Z3\nG28 Z9")[1], (Row{{1, 2, 9}, false}));
}

TEST(MachinePositions, AreKnownIfOptionsGiveThem) {
  const Options offsets{{"g54", Numbers{100, 50, -200}}};
  EXPECT_EQ(rows("G0 X0 Y0 Z0\nG53 G0 X110 Z-150", offsets)[1], (Row{{10, 0, 50}, false}));
  EXPECT_TRUE(rows("G0 X0 Y0 Z0\nG28", offsets)[1].away) << "the home's place is unknown";
  Options homes = offsets;
  homes["g28"] = Numbers{0, 0, 0};
  EXPECT_EQ(rows("G0 X0 Y0 Z0\nG28", homes)[1], (Row{{-100, -50, 200}, false}));
  EXPECT_TRUE(rows("G0 X0 Y0 Z0\nG28", {{"g28", Numbers{0, 0, 0}}})[1].away) << "the part's place is unknown";
  // The program may say it itself: G10 of the offset, G28.1 of the home.
  EXPECT_EQ(rows("G10 L2 P1 X5 Y0 Z7\nG0 X0 Y0 Z0\nG53 G0 Z0")[1], (Row{{0, 0, -7}, false}));
  EXPECT_EQ(rows("G0 X4 Y5 Z6\nG28.1\nX0 Y0 Z0\nG28")[2], (Row{{4, 5, 6}, false}));
  homes["rapids"] = std::string("straight");
  EXPECT_EQ(kinds("G0 X0 Y0 Z0\nG28\nG53 G0 Z3", homes), Kinds{});
}

TEST(MachinePositions, OfRotaryAxesAreThoseOfThePart) {
  const std::string text = "G0 X0 Y0 Z50 B30 C90\nG53 G0 Z0\nG28 B0 C0\nG0 X1 Y2\nZ5";
  const Program p = read_nc_text("G21\n" + text, "linuxcnc-xyzbc", kTable);
  EXPECT_EQ(rows(p).back(), (Row{{1, 2, 5}, false}));
  EXPECT_NEAR(p.poses().back().axis.z, 1, 1e-12);
  EXPECT_EQ(kinds(text, kTable, "linuxcnc-xyzbc"), (Kinds{"machine position", "machine position"}));
}

TEST(MachinePositions, CutsFromThemAreNotedAndArcsRefused) {
  const std::string there = "G0 X1 Y2 Z3\nG53 G0 Z0\n";
  const Kinds uncut{"machine position", "coordinates"};
  EXPECT_EQ(kinds(there + "G1 X5 F100"), uncut);
  EXPECT_EQ(kinds(there + "G1 X5 Z3 F100"), Kinds{"machine position"});
  const std::string arc = nc_error(there + "G2 X5 Z1 I2 F100");
  EXPECT_NE(arc.find("an arc or a spline where Z stands at a machine position: move there by absolute words"),
            arc.npos);
  EXPECT_EQ(nc_error(there + "Z3\nG2 X5 I2 F100"), "no error");
  // Cycles: from R on all is known under G99; G98 would come back to an unknown place.
  const Program cycle = read_nc_text("G21 " + there + "G99 G81 X5 Y6 Z-4 R2 F100\nX7");
  EXPECT_EQ(rows(cycle)[3], (Row{{5, 6, 2}, false}));
  EXPECT_EQ(cycle.poses()[4].tip, Vec3(5, 6, -4));
  EXPECT_NE(nc_error(there + "G98 G81 X5 Y6 Z-4 R2 F100").find("a canned cycle under G91 or G98"), std::string::npos);
  EXPECT_NE(nc_error(there + "#1=#5422").find("a position is read where Z stands"), std::string::npos);
  EXPECT_EQ(kinds(there + "G92 Z0\nG0 Z5"), uncut);
}

TEST(MachinePositions, MayBeTheStartOfAProgram) {
  // Zero on the table: where Z has not been named nothing is known of it.
  EXPECT_EQ(rows("G0 X1 Y2\nZ9\nX5"), (std::vector<Row>{{{1, 2, 0}, true}, {{1, 2, 9}, false}, {{5, 2, 9}, false}}));
  EXPECT_EQ(rows("G0 Z9\nX1 Y2\nX5"), (std::vector<Row>{{{0, 0, 9}, true}, {{1, 2, 9}, false}, {{5, 2, 9}, false}}));
  // A cut takes what has not been named for 0, which is noted; so does a program of rapids alone.
  EXPECT_EQ(rows("G0 Z9\nG1 X5 F100"), (std::vector<Row>{{{0, 0, 9}, false}, {{5, 0, 9}, false}}));
  EXPECT_EQ(rows("G0 X5\nY6"), (std::vector<Row>{{{5, 0, 0}, false}, {{5, 6, 0}, false}}));
  EXPECT_EQ(rows("G0 X5\nG2 X7 I1 F100")[0], (Row{{5, 0, 0}, false}));
  EXPECT_EQ(rows("G0 X1 Y2\nG28\nX3 Y4 Z5"),
            (std::vector<Row>{{{1, 2, 0}, true}, {{1, 2, 0}, true}, {{3, 4, 5}, false}}));
}

TEST(MachinePositions, StayWithTheProgram) {
  const Program p = read_nc_text(kFramed);
  EXPECT_EQ(parse_program(to_bytes(p), "p").at_machine(), p.at_machine());
  EXPECT_EQ(p.runs().size(), 1U);
  EXPECT_EQ(p.runs()[0].end, 5U);
  EXPECT_FALSE(p.moves_in_part(0) || p.moves_in_part(5) || p.moves_in_part(6));
  Program other;
  other.append({{{1, 2, 3}, {0, 0, 1}}, 0, 0, 1, 0, true});
  EXPECT_THROW(other.append({{{1, 2, 4}, {0, 0, 1}}, 0, 0, 1, 0, true, true}), std::invalid_argument);
  // The second of two programs starts at an unknown place.
  const Program later = read_nc_text("G21 G0 Z9\nX1 Y2\nG1 X5 F100");
  const Program* both[] = {&p, &later};
  const Program one = joined(both);
  EXPECT_TRUE(one.at_machine()[p.size()]);
  EXPECT_EQ(one.poses()[p.size()].tip, p.poses().back().tip);
  EXPECT_EQ(one.poses()[p.size() + 1].tip, Vec3(1, 2, 9));
}

TEST(MachinePositions, AreWrittenAsSafeHeight) {
  const std::string there = "G0 X0 Y0 Z30\nG1 Z-5 F200\nX50\nG53 G0 Z0\nX80 Y40\nZ2\nG1 Z-5\n";
  const std::string text = to_nc(read_nc_text("G21 T1 M6 S1000 M3\n" + there), for_machine("3-axis"));
  const Program back = read_nc_text(text, "3-axis");
  std::vector<Vec3> tips;
  for (const Pose& pose : back.poses()) tips.push_back(pose.tip);
  // Up where it is, across at that height, down where the program continues.
  EXPECT_EQ(tips, (std::vector<Vec3>{
                      {0, 0, 30}, {0, 0, -5}, {50, 0, -5}, {50, 0, 30}, {80, 40, 30}, {80, 40, 2}, {80, 40, -5}}))
      << text;
  // A feed move from a machine's position comes down in feed.
  const std::string plunge = "G0 X0 Y0 Z30\nG1 Z-5 F200\nG53 G0 Z0\nG1 X9 Y9 Z-5\n";
  const Program slow =
      read_nc_text(to_nc(read_nc_text("G21 T1 M6 S1000 M3\n" + plunge), for_machine("3-axis")), "3-axis");
  EXPECT_EQ(slow.poses().back().tip, Vec3(9, 9, -5));
  EXPECT_FALSE(slow.rapid().back());
  EXPECT_EQ(slow.poses()[slow.size() - 2].tip, Vec3(9, 9, 30));
}

/// On every machine that has the axes the tool is at safe height wherever it crosses.
TEST(MachinePositions, AreWrittenAsSafeHeightByEveryPost) {
  const Program p =
      read_nc_text("G21 T1 M6 S1000 M3\nG0 X0 Y0 Z40\nG1 Z-5 F200\nX50\nG53 G0 Z0\nG0 X-60 Y40\nZ-5\nG1 X0\n");
  for (const base::DescriptionEntry& entry : machines()) {
    std::string text;
    try {
      text = to_nc(p, for_machine(entry.name));
    } catch (const std::invalid_argument& e) {
      ADD_FAILURE() << entry.name << ": " << e.what();
    }
    EXPECT_FALSE(text.empty()) << entry.name;
    OptionReader taken(own_options(entry.name), "machine");
    if (make_machine(entry.name, taken)->control().language != "rs274") continue;
    const Program back = read_nc_text(text, entry.name, own_options(entry.name));
    for (std::size_t row = 1; row < back.size(); ++row) {
      const Vec3 a = back.poses()[row - 1].tip, b = back.poses()[row].tip;
      const bool crosses = (a.x > 49) != (b.x > 49) && (a.x < -59 || b.x < -59);
      EXPECT_TRUE(!crosses || std::min(a.z, b.z) > 39.9) << entry.name << "\n" << text;
    }
  }
}

TEST(WorkOffsets, OfUnknownDistanceAreNoted) {
  const std::string two = "G54 G0 X1 Y1 Z1\nG55 X2\nG54 X3\nG55 X4";
  EXPECT_EQ(kinds(two), Kinds{"work offset"});
  EXPECT_EQ(rows(two, {{"g54", Numbers{0, 0, 0}}, {"g55", Numbers{100, 0, 5}}})[1], (Row{{102, 1, 1}, false}));
  EXPECT_EQ(kinds(two, {{"g54", Numbers{0, 0, 0}}, {"g55", Numbers{100, 0, 5}}}), Kinds{});
  EXPECT_EQ(kinds(two, {{"g55", Numbers{100, 0, 5}}}), Kinds{"work offset"});
  EXPECT_EQ(kinds("G10 L2 P1 X1 Y1 Z1\nG10 L2 P2 X5 Y5 Z5\n" + two), Kinds{});
  EXPECT_EQ(kinds("G54 G0 X1 Y1 Z1\nG10 L20 P2 X0 Y0 Z0\nG55 X2"), Kinds{});
  EXPECT_EQ(kinds("G55\nG0 X1 Y1 Z1"), Kinds{}) << "one system is where the part is";
  EXPECT_EQ(kinds("G0 X1 Y1 Z1\nG10 L2 P1 X5\nX2"), Kinds{"work offset"});
}

TEST(WorkOffsets, OfOptionsAreChecked) {
  const auto refused = [](const Options& options) {
    try {
      read_nc_text("G0 X1", "tcp", options);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused({{"g54", Numbers{1, 2}}}), "machine tcp: option g54 must be 3 to 6 finite numbers");
  EXPECT_EQ(refused({{"g59_3", Numbers{1, 2, 1e9}}}), "options g54 to g59_3, g28 and g30: a number is out of range");
  EXPECT_EQ(refused({{"g28", 5.0}}), "machine tcp: option g28 must be 3 to 6 finite numbers");
}

TEST(Assumptions, OfUnitsAndOfTheStartAreNoted) {
  const auto said = [](const std::string& text, const Options& options = {}) {
    Kinds out;
    for (const Note& n : read_nc_text(text, "tcp", options).notes) out.push_back(n.kind);
    return out;
  };
  EXPECT_EQ(said("G0 X1 Y1 Z1\nX2"), Kinds{"units"});
  EXPECT_EQ(said("G20 G0 X1 Y1 Z1"), Kinds{});
  EXPECT_EQ(said("G0 X1 Y1 Z1", {{"units", std::string("mm")}}), Kinds{});
  EXPECT_EQ(read_nc_text("G0 X1", "tcp", {{"units", std::string("inch")}}).poses()[0].tip.x, 25.4);
  EXPECT_EQ(read_nc_text("G21 G0 X1", "tcp", {{"units", std::string("inch")}}).poses()[0].tip.x, 1);
  EXPECT_EQ(said("G21 G0 Z5\nG1 Z-1 F100\nX5"), Kinds{"start"});
  EXPECT_EQ(said("G21 G0 Z5\nX0 Y0\nG1 Z-1 F100"), Kinds{});
}

TEST(Assumptions, ArcsMayMissByTheGivenTolerance) {
  const std::string arc = "G21 G0 X0 Y0\nG2 X2.02 I1 F1";
  const std::string said = nc_error(arc);
  EXPECT_NE(said.find("misses its circle by 0.0200 mm: option arc_tolerance allows more"), said.npos) << said;
  EXPECT_EQ(nc_error(arc, "tcp", {{"arc_tolerance", 0.03}}), "no error");
  EXPECT_EQ(read_nc_text(arc, "tcp", {{"arc_tolerance", 0.03}}).poses().back().tip.x, 2.02);
  EXPECT_EQ(nc_error("G21 G0 X0 Y0\nG2 X2.02 R1 F1", "tcp", {{"arc_tolerance", 0.03}}), "no error");
}

TEST(Tapping, FeedsInAndOutWithTheSpindleTurnedBack) {
  const Program p = read_nc_text("G21 S500 M3\nG0 X0 Y0 Z10\nM29 S500\nG99 G84 X5 Y6 Z-8 R3 F400\nX9\nG80 G0 Z10");
  ASSERT_EQ(p.size(), 9U);
  EXPECT_EQ(p.poses()[3].tip, Vec3(5, 6, -8));
  EXPECT_EQ(p.poses()[4].tip, Vec3(5, 6, 3));
  EXPECT_FALSE(p.rapid()[3] || p.rapid()[4]);
  EXPECT_EQ(p.spindle()[3], 500);
  EXPECT_EQ(p.spindle()[4], -500);
  EXPECT_EQ(p.spindle()[5], 500) << "the next hole";
  const Program left = read_nc_text("G21 S500 M4\nG0 X0 Y0 Z10\nG98 G74 X5 Y6 Z-8 R3 F400");
  EXPECT_EQ(left.spindle()[3], -500);
  EXPECT_EQ(left.spindle()[4], 500);
  EXPECT_EQ(left.poses().back().tip.z, 10);
  // In pecks the tap comes out in feed each time.
  const Program pecks = read_nc_text("G21 S500 M3\nG0 X0 Y0 Z10\nG99 G84 X5 Y6 Z-7 R3 Q5 F400");
  ASSERT_EQ(pecks.size(), 7U);
  EXPECT_EQ(pecks.poses()[3].tip.z, -2);
  EXPECT_EQ(pecks.poses()[4].tip.z, 3);
  EXPECT_FALSE(pecks.rapid()[4]);
}

}  // namespace
}  // namespace riffler::nc::machine_position_test
