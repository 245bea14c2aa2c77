// What each language makes of the same program.
#include "nc/write/post.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>

#include "riffler/nc/cutter_path.hpp"
#include "riffler/nc/read/reader.hpp"
#include "riffler/nc/write/writer.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/error_of.hpp"
#include "support/nc_blocks.hpp"

namespace riffler::nc::post_test {
namespace {

Program two_tools() {
  std::vector<CutterPath> paths;
  for (int k = 0; k < 2; ++k) {
    CutterPath path{{}, {600.0 + k}, k ? -9000.0 : 8000.0, 1 + k};
    for (int i = 0; i < 6; ++i)
      path.poses.push_back({{10.0 * i, 2.0 * i * i, -k - 0.5 * i}, glm::normalize(Vec3(0.1 * i, 0.2 - 0.1 * i, 1))});
    paths.push_back(path);
  }
  Program p = program_from_paths(paths, {});
  p.tools.emplace(1, cutters::ball(6, 30));
  p.provenance = {{"part", "ä (1).stl"}};
  return p;
}

std::string text_of(const Program& p, const char* post, Options options = {}) {
  WriteOptions how;
  how.post = post, how.options = std::move(options);
  return to_nc(p, how);
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

TEST(Rs274Post, NumbersLinesOnRequest) {
  int expected = 0;
  for (const std::string& line : lines(text_of(two_tools(), "tcp", {{"line_numbers", 5.0}}))) {
    if (line[0] == '(') continue;
    EXPECT_TRUE(line.starts_with("N" + std::to_string(expected += 5) + " ")) << line;
  }
  const std::string numbered = text_of(two_tools(), "tcp", {{"line_numbers", 1.0}});
  const Program a = parse_nc(numbered, "p.ngc"), b = parse_nc(text_of(two_tools(), "tcp"), "p.ngc");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t row = 0; row < a.size(); ++row) EXPECT_EQ(a.poses()[row].tip, b.poses()[row].tip);
}

TEST(Rs274Post, SwitchesCoolantAndRetractsOnRequest) {
  const std::string text = text_of(two_tools(), "tcp", {{"coolant", std::string("flood")}, {"retract", -2.5}});
  std::size_t retracts = 0;
  for (const std::string& line : lines(text)) retracts += line == "G53 G0 Z-2.5";
  EXPECT_EQ(retracts, 3U) << "before everything, before the second tool, after everything";
  EXPECT_NE(text.find("M8\nG0 A"), text.npos);
  EXPECT_NE(text.find("M9\nG49\nG53 G0 Z-2.5\nM30\n"), text.npos);
  // After it, all words are written again.
  EXPECT_NE(text.find("G43.4 H1\nG0 X"), text.npos);
}

TEST(Rs274Post, RetractsThenTurnsThenGoesAcrossThenDown) {
  const Program p = two_tools();
  const std::string text = text_of(p, "tcp");
  const auto all = lines(text);
  EXPECT_EQ(std::count(all.begin(), all.end(), "G53 G0 Z0"), 3) << "before each tool and at the end";
  for (const int tool : {1, 2}) {
    const auto call = std::find(all.begin(), all.end(), "T" + std::to_string(tool) + " M6");
    ASSERT_NE(call, all.end());
    EXPECT_EQ(*(call - 1), "G53 G0 Z0");
    EXPECT_TRUE((call + 1)->starts_with("S")) << *(call + 1);
    EXPECT_TRUE((call + 2)->starts_with("G0 A") && (call + 2)->find(" C") != std::string::npos &&
                (call + 2)->find_first_of("XYZ") == std::string::npos)
        << *(call + 2);
    EXPECT_EQ(*(call + 3), "G43.4 H" + std::to_string(tool)) << "the control keeps the tip only once the axes stand";
    EXPECT_TRUE((call + 4)->starts_with("G0 X") && (call + 4)->find(" Y") != std::string::npos &&
                (call + 4)->find('Z') == std::string::npos)
        << *(call + 4);
    EXPECT_TRUE((call + 5)->starts_with("Z") || (call + 5)->starts_with("G0 Z")) << *(call + 5);
  }
  EXPECT_TRUE(text.ends_with("\nM5\nG49\nG53 G0 Z0\nM30\n"));
  // Without it: one block from wherever the machine is, and no retract.
  const std::string plain = text_of(p, "tcp", {{"safe_start", false}});
  EXPECT_EQ(plain.find("G53"), plain.npos);
  EXPECT_NE(plain.find("G43.4 H1\nG0 X"), plain.npos);
  EXPECT_NE(plain.find("G43.4 H2\nG0 X"), plain.npos);
  EXPECT_EQ(text_of({}, "tcp").find("G53"), text.npos) << "nothing moves";
}

TEST(Rs274Post, ReadsBackWithoutTheBlocksThatBringATool) {
  // Where the tool is between the machine's own retract and the first Z is not in the program: no row of the part, and
  // no rapid through the part's zero.
  const Program p = two_tools();
  const Options table{{"rot_point", std::vector<double>{3, 4, -50}}};
  for (const char* post : {"tcp", "tcp-bc", "linuxcnc-xyzac", "linuxcnc-xyzbc", "head-head", "head-table"})
    for (const double step : {0.0, 10.0}) {
      const Options options = std::string(post).starts_with("linuxcnc") ? table : Options{};
      Options how = options;
      how["line_numbers"] = step;
      const Program q = parse_nc(text_of(p, post, how), "p.ngc", {post, options});
      std::size_t row = 0;
      for (std::size_t k = 0; k < q.size(); ++k) {
        if (q.at_machine()[k]) continue;
        const Vec3& tip = q.poses()[k].tip;
        // Every row of the code is on the move to the program's next row.
        const Vec3 from = p.poses()[row > 0 ? row - 1 : 0].tip, way = p.poses()[row].tip - from;
        const double length2 = glm::dot(way, way);
        const double t = length2 > 0 ? std::clamp(glm::dot(tip - from, way) / length2, 0.0, 1.0) : 0;
        ASSERT_LT(glm::length(tip - from - t * way), 0.011) << post << ", row " << k;
        EXPECT_EQ(q.tool()[k], p.tool()[row]);
        EXPECT_EQ(q.rapid()[k], p.rapid()[row]);
        const bool ends =
            glm::length(tip - p.poses()[row].tip) < 2e-5 && test::angle(q.poses()[k].axis, p.poses()[row].axis) < 1e-6;
        if (ends && row + 1 < p.size()) ++row;
      }
      EXPECT_EQ(row, p.size() - 1) << post;
    }
}

TEST(Rs274Post, MakesArcsOfStraightRunsWithinTheTolerance) {
  CutterPath path{{}, {600}, 8000, 1};
  for (int i = 0; i <= 300; ++i) {
    const double a = 0.03 * i;
    path.poses.push_back({{20 * std::cos(a), 20 * std::sin(a), -0.01 * i}, glm::normalize(Vec3(0.2, 0, 1))});
  }
  for (int i = 1; i <= 20; ++i) path.poses.push_back({path.poses[300].tip + Vec3(i, 0, 0), path.poses[300].axis});
  const Program p = program_from_paths(std::vector{path}, {});
  for (const char* post : {"tcp", "tcp-bc", "linuxcnc-xyzac", "heidenhain"}) {
    Options table{{"safe_start", false}}, options;
    if (post == std::string("linuxcnc-xyzac")) options["rot_point"] = table["rot_point"] = std::vector<double>{0, 0, 0};
    const std::string straight = text_of(p, post, table);
    table["arcs"] = true;
    const std::string curved = text_of(p, post, table);
    if (post == std::string("heidenhain")) {
      EXPECT_EQ(straight, curved) << "the post has none";
      continue;
    }
    EXPECT_LT(lines(curved).size() + 250, lines(straight).size()) << post;
    EXPECT_NE(curved.find("G3 X"), curved.npos);
    const Program q = parse_nc(curved, "p.ngc", {post, options});
    // Every row of either is near a move of the other.
    const auto beside = [](const Program& a, const Program& b) {
      double worst = 0;
      for (std::size_t row = 0; row < a.size(); ++row) {
        if (a.rapid()[row]) continue;
        const Pose& is = a.poses()[row];
        double least = 1e9;
        for (std::size_t k = 1; k < b.size(); ++k) {
          const Vec3 from = b.poses()[k - 1].tip, way = b.poses()[k].tip - from;
          const double t = glm::dot(way, way) > 0 ? glm::dot(is.tip - from, way) / glm::dot(way, way) : 0;
          least = std::min(least, glm::length(is.tip - from - std::clamp(t, 0.0, 1.0) * way));
        }
        worst = std::max(worst, least);
      }
      return worst;
    };
    EXPECT_LT(beside(p, q), 0.012) << post;
    EXPECT_LT(beside(q, p), 0.012) << post;
  }
}

TEST(HeidenhainPost, CountsItsBlocksAndKeepsTheTip) {
  const auto all = lines(text_of(two_tools(), "heidenhain", {{"coolant", std::string("mist")}}));
  for (std::size_t k = 0; k < all.size(); ++k) EXPECT_TRUE(all[k].starts_with(std::to_string(k) + " ")) << all[k];
  EXPECT_EQ(all.front(), "0 BEGIN PGM RIFFLER MM");
  EXPECT_TRUE(all.back().ends_with(" END PGM RIFFLER MM"));
  std::string text;
  for (const std::string& line : all) text += line.substr(line.find(' ') + 1) + "\n";
  EXPECT_NE(text.find("; part: ?? [1].stl"), text.npos);
  EXPECT_NE(text.find("L M140 MB MAX\nTOOL CALL 1 Z S8000\nM3\nM7\nL A"), text.npos);
  EXPECT_NE(text.find("M129\nM5\nL M140 MB MAX\nTOOL CALL 2 Z S9000\nM4\nM7\nL A"), text.npos);
  // The rotary axes turn before the control keeps the tip, then the tool goes across, then down.
  EXPECT_TRUE(std::regex_search(
      text, std::regex("\nL A[^ ]+ C[^ ]+ R0 FMAX\nM128\nL X[^ ]+ Y[^ ]+ FMAX\nL X[^ ]+ Z[^ ]+ FMAX\n")))
      << text;
  EXPECT_NE(text.find(" FMAX\n"), text.npos);
  EXPECT_NE(text.find(" F600\n"), text.npos);
  EXPECT_TRUE(text.find("M129\nM5\nM9\nL M140 MB MAX\nM30\nEND PGM") != text.npos);
}

/// Poses of L and LN blocks: axis words as tcp has them, or the vector.
std::vector<Pose> heidenhain_poses(const std::string& text) {
  std::vector<Pose> out;
  std::map<std::string, double> at;
  for (const std::string& line : lines(text)) {
    std::istringstream in(line);
    std::string number, kind, word;
    in >> number >> kind;
    if (kind != "L" && kind != "LN") continue;
    while (in >> word) {
      const std::size_t sign = word.find_first_of("+-");
      if (sign != word.npos) at[word.substr(0, sign)] = std::stod(word.substr(sign));
    }
    const Vec3 axis = kind == "LN" ? Vec3(at["TX"], at["TY"], at["TZ"]) : Vec3(test::axis_of(at["A"], at["C"]));
    out.push_back({{at["X"], at["Y"], at["Z"]}, axis});
  }
  return out;
}

TEST(HeidenhainPost, HoldsEveryPoseByAnglesAndByVectors) {
  const Program p = two_tools();
  for (const bool vectors : {false, true}) {
    const auto poses = heidenhain_poses(text_of(p, "heidenhain", {{"vectors", vectors}}));
    std::size_t at = 0;
    for (const Pose& wanted : p.poses()) {
      while (at < poses.size() &&
             (glm::length(poses[at].tip - wanted.tip) > 1e-5 || test::angle(poses[at].axis, wanted.axis) > 1e-7))
        ++at;
      ASSERT_LT(at, poses.size()) << (vectors ? "vectors" : "angles");
    }
  }
}

TEST(AptPost, RefusesRowsThatNoCodeCanHold) {
  Program far;
  far.append({{{0, 1e15, 0}, {0, 0, 1}}, 1});
  for (const Options& options : {Options{}, Options{{"vectors", true}}})
    EXPECT_EQ(test::error_of([&] { text_of(far, options.empty() ? "apt" : "heidenhain", options); }),
              "poses, row 0: Y is out of range");
}

TEST(AptPost, WritesEveryRowUnchanged) {
  const Program p = two_tools();
  const auto all = lines(text_of(p, "apt"));
  EXPECT_EQ(all.front(), "PARTNO RIFFLER");
  EXPECT_EQ(all.back(), "FINI");
  std::vector<Pose> poses;
  std::vector<bool> rapids;
  bool rapid = false;
  for (const std::string& line : all) {
    EXPECT_LE(line.size(), 250U);
    if (line == "RAPID") rapid = true;
    if (!line.starts_with("GOTO/")) continue;
    Pose pose;
    ASSERT_EQ(std::sscanf(line.c_str(), "GOTO/%lf,%lf,%lf,%lf,%lf,%lf", &pose.tip.x, &pose.tip.y, &pose.tip.z,
                          &pose.axis.x, &pose.axis.y, &pose.axis.z),
              6);
    poses.push_back(pose), rapids.push_back(rapid);
    rapid = false;
  }
  ASSERT_EQ(poses.size(), p.size());
  for (std::size_t row = 0; row < p.size(); ++row) {
    EXPECT_LT(glm::length(poses[row].tip - p.poses()[row].tip), 1e-5);
    EXPECT_LT(glm::length(poses[row].axis - p.poses()[row].axis), 2e-9);
    EXPECT_EQ(rapids[row], p.rapid()[row] != 0);
  }
  const auto has = [&](const std::string& line) { return std::find(all.begin(), all.end(), line) != all.end(); };
  EXPECT_TRUE(has("CUTTER/6,3,0,3,0,0,30"));
  EXPECT_TRUE(has("SPINDL/8000,RPM,CLW"));
  EXPECT_TRUE(has("SPINDL/9000,RPM,CCLW"));
  EXPECT_TRUE(has("FEDRAT/600,MMPM"));
}

}  // namespace
}  // namespace riffler::nc::post_test
