// Random rows, of which some machines can run some, and the shipped machines with what limits them.
#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "nc/limits.hpp"
#include "nc/machine/machines.hpp"
#include "nc/machine/shipped_machines.hpp"
#include "riffler/nc/program.hpp"
#include "riffler/nc/write/write_options.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/tilted.hpp"

namespace riffler::test {

inline nc::WriteOptions on_machine(std::string post, nc::Options options = {}) {
  nc::WriteOptions how;
  how.post = std::move(post), how.options = std::move(options);
  return how;
}

/// `options` and what the machine cannot do without: points at 0, lengths of 120 mm.
inline nc::Options with_needed(const std::string& name, nc::Options options) {
  nc::OptionReader listing(options, name, true);
  make_machine(name, listing);
  for (const nc::OptionFact& fact : listing.facts()) {
    if (!fact.needed) continue;
    if (fact.most == 3) options[fact.name] = std::vector<double>{0, 0, 0};
    if (fact.most == 1) options[fact.name] = 120.0;
  }
  return options;
}

/// Every shipped machine: with its defaults, with tip words for joint words or joint words for tip words, with limits,
/// and with options of posts.
inline std::vector<nc::WriteOptions> all_machines() {
  std::vector<nc::WriteOptions> out;
  for (const base::ShippedText& text : nc::shipped_machines()) {
    const std::string name(text.name);
    nc::OptionReader listing({}, name, true);
    const auto machine = make_machine(name, listing);
    std::vector<nc::Options> words{with_needed(name, {})};
    if (machine->control().language == "rs274" && machine->axes().size() > 3)
      words.push_back(with_needed(name, {{"tcp", machine->joint_words()}}));
    for (const nc::Options& options : words) {
      out.push_back(on_machine(name, options));
      nc::Options limited = options, asked = options;
      for (const char letter : machine->axes().substr(3))
        limited[std::string("limits_") + static_cast<char>(letter + ('a' - 'A'))] = std::vector<double>{-100, 35};
      limited["limits_x"] = std::vector<double>{-60, 60};
      out.push_back(on_machine(name, limited));
      asked["safe_height"] = 25.0, asked["arcs"] = true;
      out.push_back(on_machine(name, asked));
    }
    if (machine->control().language == "heidenhain") out.push_back(on_machine(name, {{"vectors", true}}));
  }
  return out;
}

/// Rows that some machines can run and others cannot: leaning, turning over, far away, without feeds, with via poses,
/// at positions of the machine.
class RandomRows {
 public:
  explicit RandomRows(unsigned seed) : random_(seed) {}

  nc::Program program() {
    nc::Program p;
    if (chance(0.8)) p.tools.emplace(1, cutters::ball(6, 40).with_holder({{40, 20, 90, 20}}));
    steepest_ = chance(0.4) ? 0 : chance(0.5) ? 30 : 175;
    const bool feeds = !chance(0.08), far = chance(0.1);
    nc::Move move = first();
    for (int row = 0, rows = 1 + static_cast<int>(number(0, 30)); row < rows; ++row) {
      if (row > 0) next(move, feeds);
      if (far && !move.at_machine && chance(0.1)) move.pose.tip.x = 3 * nc::kMaxLength;
      if (!feeds) move.pose.tip = Vec3(1, 2, 3);
      p.append(move);
      move.at_machine = false, move.via = nullptr;
    }
    return p;
  }

 private:
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  bool chance(double share) { return number(0, 1) < share; }
  Vec3 axis() { return chance(0.1) ? Vec3(0, 0, 1) : tilted(number(0, steepest_), number(0, 360)); }

  nc::Move first() {
    nc::Move move;
    move.pose = {{0, 0, 30}, axis()};
    move.tool = 1, move.spindle = 8000, move.rapid = chance(0.8);
    return move;
  }

  void next(nc::Move& move, bool feeds) {
    if (feeds && chance(0.03)) {
      move.at_machine = true;
      return;
    }
    const Pose before = move.pose;
    move.rapid = feeds && chance(0.2);
    move.pose.tip = {number(-50, 50), number(-50, 50), move.rapid && chance(0.7) ? 30 : number(-5, 15)};
    if (chance(0.6)) move.pose.axis = axis();
    if (chance(0.01)) move.pose.axis = -before.axis;
    move.feed = move.rapid || !feeds ? 0 : number(100, 2000);
    if (chance(0.05)) move.tool = 3 - move.tool;
    if (chance(0.05))
      move.via =
          std::make_shared<const std::vector<Pose>>(std::vector<Pose>{{(before.tip + move.pose.tip) / 2.0, axis()}});
  }

  std::mt19937 random_;
  double steepest_ = 0;  // deg
};

}  // namespace riffler::test
