#include "riffler/nc/write/writer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <regex>
#include <stdexcept>

#include "base/io.hpp"
#include "riffler/base/error.hpp"
#include "riffler/nc/cutter_path.hpp"
#include "riffler/nc/read/reader.hpp"
#include "support/nc_blocks.hpp"

namespace riffler::nc::writer_test {
namespace {

using test::angle;
using test::block_ends;
using test::pose_between;

std::string slurp(const std::filesystem::path& path) {
  const auto bytes = base::read_file(path);
  return {bytes.begin(), bytes.end()};
}

/// Two cuts on a wavy path with a swaying axis that also passes the pole.
std::vector<CutterPath> swaying(int rows) {
  std::vector<CutterPath> paths;
  for (int k = 0; k < 2; ++k) {
    CutterPath path{{}, {600.0 + k}, 9000, 1 + k};
    for (int i = 0; i < rows; ++i) {
      const double t = static_cast<double>(i) / rows;
      path.poses.push_back({{80 * t, 20 * std::sin(9 * t), -5 * t * k},
                            glm::normalize(Vec3(std::sin(7 * t), std::sin(5 * t + k) - 0.3 * k, 1))});
    }
    paths.push_back(path);
  }
  return paths;
}

Program upright(int rows) {
  CutterPath path{{}, {500}, 0, 1};
  for (int i = 0; i < rows; ++i) path.poses.push_back({{1.0 * i, 0.1 * i, -0.3 * i}, {0, 0, 1}});
  return program_from_paths(std::vector{path}, {});
}

TEST(Writer, EveryRowEndsABlockAndBlocksKeepToTheMove) {
  const Program p = program_from_paths(swaying(40), {});
  for (const double axis_tolerance : {0.00175, 1e-4}) {
    WriteOptions options;
    options.axis_tolerance = axis_tolerance, options.options["safe_start"] = false;
    const auto blocks = block_ends(to_nc(p, options));
    std::size_t block = 0;
    for (std::size_t row = 0; row < p.size(); ++row) {
      const Pose& wanted = p.poses()[row];
      const std::size_t first = block;
      const auto ends_here = [&](const test::NcBlockEnd& b) {
        const Pose pose = pose_between(b, b, 0);
        return glm::length(pose.tip - wanted.tip) < 1e-5 && angle(pose.axis, wanted.axis) < 2e-6;
      };
      while (block < blocks.size() && !ends_here(blocks[block])) ++block;
      ASSERT_LT(block, blocks.size()) << "row " << row << " ends no block";
      ++block;
      if (row == 0) continue;
      const Motion motion(p.poses()[row - 1], wanted);
      for (std::size_t b = first; b < block; ++b) {
        EXPECT_EQ(blocks[b].rapid, p.rapid()[row] != 0);
        if (blocks[b].rapid) continue;
        EXPECT_NEAR(blocks[b].at.at('F'), p.feed()[row], 1e-9);
        for (int i = 0; i <= 20; ++i) {
          const Pose is = pose_between(blocks[b - 1], blocks[b], i / 20.0);
          const Vec3 d = wanted.tip - motion.from().tip;
          const double t = glm::dot(is.tip - motion.from().tip, d) / glm::dot(d, d);
          EXPECT_LT(glm::length(is.tip - motion.tip(t)), 2e-5);
          EXPECT_LT(angle(is.axis, motion.axis(std::clamp(t, 0.0, 1.0))), axis_tolerance + 1e-5) << "row " << row;
        }
      }
    }
    EXPECT_EQ(block, blocks.size());
  }
}

TEST(Writer, ReadsBackAsTheSameProgram) {
  const Program p = program_from_paths(swaying(40), {});
  const Program q = parse_nc(to_nc(p), "p.ngc");
  std::size_t at = 0;
  for (std::size_t row = 0; row < p.size(); ++row, ++at) {
    while (at < q.size() && glm::length(q.poses()[at].tip - p.poses()[row].tip) > 1e-5) ++at;
    ASSERT_LT(at, q.size()) << "row " << row;
    EXPECT_LT(angle(q.poses()[at].axis, p.poses()[row].axis), 2e-6);
    EXPECT_EQ(q.rapid()[at], p.rapid()[row]);
    EXPECT_NEAR(q.feed()[at], p.feed()[row], 1e-6);
    EXPECT_EQ(q.tool()[at], p.tool()[row]);
    EXPECT_EQ(q.spindle()[at], p.spindle()[row]);
  }
}

TEST(Writer, KeepsRowsThatDoNotMove) {
  const Pose a{{1, 2, 3}, {0, 0, 1}};
  const Program p = program_from_paths(std::vector<CutterPath>{{{a, a, a}, {100}, 0, 1}}, {});
  for (const char* post : {"tcp", "3-axis"}) {
    WriteOptions options;
    options.post = post, options.options["safe_start"] = false;
    EXPECT_EQ(parse_nc(to_nc(p, options), "p.ngc", {post, {}}).size(), p.size()) << post;
  }
}

TEST(Writer, WritesTheBeginningAndEndThatControlsExpect) {
  Program p = program_from_paths(swaying(3), {});
  p.provenance = {{"part", "shoe (left) \xC3\xA9.stl"}, {"LOGOPEN,x", "y"}};
  p.tools.emplace(1,
                  Tool("ball", {{"diameter", 6.0}}, tool::Profile({{{3, 3}, Vec2(0, 3)}, {{3, 30}, {}}})).named("B6"));
  const std::string text = to_nc(p);
  EXPECT_EQ(text, to_nc(p)) << "same program, same bytes";
  for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~'));
  EXPECT_LT(text.find("G21"), text.find("G0 "));
  EXPECT_LT(text.find("G94"), text.find("G0 "));
  EXPECT_NE(text.find("(part: shoe [left] ??.stl)"), std::string::npos);
  EXPECT_EQ(text.find("(LOGOPEN,"), std::string::npos) << "a comment must not be a command";
  EXPECT_NE(text.find("(T1: ball, diameter 6, named B6)"), std::string::npos);
  EXPECT_NE(text.find("G53 G0 Z0\nT1 M6\nS9000 M3\nG0 A"), std::string::npos);
  EXPECT_NE(text.find("M5\nG49\nG53 G0 Z0\nT2 M6\nS9000 M3\nG0 A"), std::string::npos) << "all words after the change";
  EXPECT_TRUE(text.ends_with("\nM5\nG49\nG53 G0 Z0\nM30\n"));
}

TEST(Writer, PrintsAtLeastFiveDecimalsAndSixForAngles) {
  WriteOptions options;
  options.options["safe_start"] = false;
  const std::string text = to_nc(program_from_paths(swaying(30), {}), options);
  EXPECT_FALSE(std::regex_search(text, std::regex("\n[^(\n]*[XYZ]-?[0-9]*(\\.[0-9]{0,4})?[ \n]")));
  EXPECT_FALSE(std::regex_search(text, std::regex("\n[^(\n]*[AC]-?[0-9]*(\\.[0-9]{0,5})?[ \n]")));
  EXPECT_EQ(text.find("-0.00000 "), std::string::npos);
}

TEST(Writer, WritesModalWordsOnce) {
  const std::string text = to_nc(upright(50));
  const auto count = [&](const std::string& word) {
    std::size_t n = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("G1"), 2U) << "G17 and one G1";
  EXPECT_EQ(count("F500"), 1U);
  EXPECT_EQ(count(" A0"), 1U);
  EXPECT_EQ(count(" C0"), 1U);
}

TEST(Writer, TakesTheFeedOfTheNextMoveIfTheTipStandsStill) {
  Program p;
  p.append({{{0, 0, 0}, {0, 0, 1}}, 0, 0, 1, 0, true});
  p.append({{{0, 0, 0}, {0, 0.6, 0.8}}, 0, 0, 1, 0, false});
  EXPECT_THROW(to_nc(p), std::invalid_argument);
  p.append({{{1, 0, 0}, {0, 0.6, 0.8}}, 250, 0, 1, 0, false});
  for (const auto& block : block_ends(to_nc(p))) EXPECT_TRUE(block.rapid || block.at.at('F') == 250);
}

TEST(Writer, WritesTheSmallestFeedAsMoreThanZero) {
  Program p;
  p.append({{{0, 0, 0}, {0, 0, 1}}, 1e-9, 0, 1, 0, false});
  EXPECT_GT(parse_nc(to_nc(p, {.options = {{"safe_start", false}}}), "p.ngc").feed()[0], 0);
}

std::string error_of(const Program& p, const WriteOptions& options) {
  try {
    to_nc(p, options);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(Writer, NamesBadInput) {
  const Program p = upright(3);
  EXPECT_EQ(error_of(p, {}), "");
  WriteOptions options;
  options.post = "lathe";
  EXPECT_TRUE(error_of(p, options).starts_with("unknown post lathe; known: tcp, tcp-bc, linuxcnc-xyzac, "));
  options.post = "linuxcnc_xyzab";
  EXPECT_TRUE(error_of(p, options)
                  .starts_with("unknown post linuxcnc_xyzab; did you mean linuxcnc-xyzac? known: tcp, tcp-bc, "))
      << error_of(p, options);
  options = {};
  options.options["offset"] = 1.0;
  EXPECT_EQ(
      error_of(p, options),
      "post tcp: unknown option 'offset'; known: tcp, max_rotary, limits_x, rate_x, limits_y, rate_y, limits_z, "
      "rate_z, limits_a, rate_a, limits_c, rate_c, tool_length, feed, rapids, line_numbers, coolant, vectors, retract, "
      "safe_start, safe_height, arcs");
  options.options = {{"safe_hight", 30.0}};
  EXPECT_TRUE(
      error_of(p, options)
          .starts_with("post tcp: unknown option 'safe_hight'; did you mean safe_height? known: tcp, max_rotary, "))
      << error_of(p, options);
  options = {};
  options.tolerance = 0;
  EXPECT_NE(error_of(p, options).find("tolerance"), std::string::npos);
  options = {};
  options.axis_tolerance = std::nan("");
  EXPECT_NE(error_of(p, options).find("axis_tolerance"), std::string::npos);
  Program far;
  far.append({{{2e6, 0, 0}, {0, 0, 1}}, 1});
  EXPECT_EQ(error_of(far, {}), "poses, row 0: X is out of range");
  options = {};
  options.post = "3-axis";
  EXPECT_NE(error_of(program_from_paths(swaying(3), {}), options).find("poses, row 2: the axis is not (0, 0, 1)"),
            std::string::npos);
}

TEST(Writer, AFailedWriteLeavesTheOldFile) {
  const auto path = std::filesystem::temp_directory_path() / "riffler_writer_test.ngc";
  write_nc(upright(3), path);
  const std::string before = slurp(path);
  EXPECT_EQ(before, to_nc(upright(3)));
  Program bad = upright(3);
  bad.append({{{0, 0, 0}, {1, 0, 0}}, 100});
  WriteOptions options;
  options.post = "3-axis";
  EXPECT_THROW(write_nc(bad, path, options), std::invalid_argument);
  EXPECT_EQ(slurp(path), before);
  std::filesystem::remove(path);
  EXPECT_THROW(write_nc(bad, "/nowhere/at/all.ngc"), std::runtime_error);
}

TEST(Writer, WritesAnEmptyProgram) {
  EXPECT_TRUE(parse_nc(to_nc(Program()), "p.ngc").empty());
}

TEST(Writer, MutatedTextDoesNotPass) {
  const Program p = program_from_paths(swaying(20), {});
  const std::string text = to_nc(p);
  const Program same = parse_nc(text, "p.ngc");
  const auto differs = [&](const std::string& mutated) {
    const Program q = parse_nc(mutated, "p.ngc");
    double worst = 0;
    for (std::size_t row = 0; row < std::min(q.size(), same.size()); ++row)
      worst = std::max(worst, angle(q.poses()[row].axis, same.poses()[row].axis));
    return q.size() != same.size() || worst > 0.01;
  };
  EXPECT_FALSE(differs(text));
  EXPECT_TRUE(differs(
      std::regex_replace(std::regex_replace(text, std::regex(" C-"), " C+"), std::regex(" C([0-9])"), " C-$1")));
  EXPECT_TRUE(differs(
      std::regex_replace(std::regex_replace(text, std::regex(" A-"), " A+"), std::regex(" A([0-9])"), " A-$1")));
  EXPECT_THROW(differs(std::regex_replace(text, std::regex(" A"), " B")), FormatError);
  EXPECT_THROW(differs(std::regex_replace(text, std::regex(" F[0-9.]+"), "")), FormatError);
}

}  // namespace
}  // namespace riffler::nc::writer_test
