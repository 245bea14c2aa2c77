// A second, naive reader of NC text for tests: what the writer wrote, without the code under test. Absolute
// millimetres, G0 and G1 only; the tool axis by products of rotation matrices.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "riffler/geom/pose.hpp"

namespace riffler::test {

struct NcBlockEnd {
  std::map<char, double> at;            // modal values of X Y Z A B C and F after the block
  bool rapid = false, inverse = false;  // G93
  bool fed = false;                     // F stands in this very block
};

/// The ends of all blocks that move something.
inline std::vector<NcBlockEnd> block_ends(const std::string& text) {
  std::vector<NcBlockEnd> out;
  NcBlockEnd now;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '(') continue;
    std::istringstream words(line);
    bool moves = false;
    now.fed = false;
    for (std::string word; words >> word;) {
      const double value = std::stod(word.substr(1));
      if (word == "G0" || word == "G1")
        now.rapid = word == "G0";
      else if (std::string("XYZABC").find(word[0]) != std::string::npos)
        now.at[word[0]] = value, moves = true;
      else if (word[0] == 'F')
        now.at['F'] = value, now.fed = true;
      else if (word == "G93" || word == "G94")
        now.inverse = word == "G93";
    }
    if (moves) out.push_back(now);
  }
  return out;
}

/// Rz(c) · Rx(a) · e_z with whole matrices, degrees.
inline Vec3 axis_of(double a, double c) {
  const double d = std::acos(-1.0) / 180;
  const Mat3 rx(Vec3(1, 0, 0), Vec3(0, std::cos(a * d), std::sin(a * d)), Vec3(0, -std::sin(a * d), std::cos(a * d)));
  const Mat3 rz(Vec3(std::cos(c * d), std::sin(c * d), 0), Vec3(-std::sin(c * d), std::cos(c * d), 0), Vec3(0, 0, 1));
  return rz * (rx * Vec3(0, 0, 1));
}

/// The pose at share `s` of the block from `a` to `b`, every word moving linearly.
inline Pose pose_between(const NcBlockEnd& a, const NcBlockEnd& b, double s) {
  const auto mixed = [&](char letter) {
    const auto value = [&](const NcBlockEnd& e) { return e.at.contains(letter) ? e.at.at(letter) : 0.0; };
    return value(a) + s * (value(b) - value(a));
  };
  return {{mixed('X'), mixed('Y'), mixed('Z')}, axis_of(mixed('A'), mixed('C'))};
}

inline double angle(const Vec3& a, const Vec3& b) {
  return 2 * std::asin(std::min(1.0, glm::length(a - b) / 2));
}

}  // namespace riffler::test
