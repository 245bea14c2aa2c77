// One program, fed in one go, in chunks, as packets to a worker, and after an edit: one report.
#include "verify/slab_run.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "riffler/base/parallel.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/nc/edit.hpp"
#include "riffler/tool/cutters.hpp"
#include "riffler/verify/verification.hpp"
#include "support/box_mesh.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"
#include "support/tilted.hpp"
#include "verify/remote.hpp"
#include "verify/verify_plan.hpp"

namespace riffler::verify::slab_run_test {
namespace {

using test::box_mesh;
using test::error_of;
using test::tilted;

const Vec3 kUp(0, 0, 1);

VerifyArguments arguments() {
  const auto part = std::make_shared<const Mesh>(box_mesh({2, 2, -12}, {38, 28, -6}));
  VerifyArguments out{.stock = Volume::block({{{0, 0, -12}, {40, 30, 0}}, 0.5, "xyz"}), .part = part};
  out.fixtures.push_back(Volume::block({{{36, 0, 0}, {40, 30, 8}}, 0.5, "z"}));
  out.options.rest_tolerance = 1.0;
  out.options.machine = MachineChoice{"tcp", {{"limits_a", std::vector<double>{-20, 20}}}};
  return out;
}

/// Cuts, gouges, rapids in material, a spindle that stands, holders in material and in the fixture, swings with via
/// poses, and rows that the machine cannot hold.
nc::Program mixed(std::size_t rows, unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  nc::Program p;
  p.tools.emplace(1, cutters::ball(4, 8).with_holder({{8, 6, 30, 6}}));
  p.tools.emplace(2, cutters::flat(6, 5));
  nc::Move move{{{0, 0, 20}, kUp}, 0, 8000, 1, 1, true};
  for (std::size_t row = 0; row < rows; ++row) {
    p.append(move);
    const Pose before = move.pose;
    move.line = static_cast<std::int32_t>(row) + 2, move.via = nullptr;
    move.rapid = number(0, 1) < 0.15;
    move.pose.tip = {number(-2, 42), number(-2, 32), move.rapid && number(0, 1) < 0.8 ? 20 : number(-8, 2)};
    if (number(0, 1) < 0.2) move.pose.axis = tilted(number(0, 25), number(0, 360));
    move.feed = move.rapid ? 0 : 900;
    move.spindle = number(0, 1) < 0.05 ? 0 : 8000;
    if (number(0, 1) < 0.03) move.tool = 3 - move.tool;
    if (number(0, 1) < 0.05) {
      const Pose middle{(before.tip + move.pose.tip) / 2.0, tilted(10, number(0, 360))};
      move.via = std::make_shared<const std::vector<Pose>>(std::vector<Pose>{middle});
    }
  }
  p.notes = {{"work offset", 3, "G55 taken as G54"}};
  return p;
}

/// Each after the first begins with the row at which the one before ends.
std::vector<nc::Program> chunks_of(const nc::Program& program, std::size_t rows) {
  std::vector<nc::Program> out;
  for (std::size_t begin = 0; begin == 0 || begin + 1 < program.size(); begin += rows)
    out.push_back(trimmed(program, begin, std::min(program.size(), begin + rows + 1)));
  return out;
}

VerifyReport fed(const std::vector<nc::Program>& chunks) {
  SlabRun run(arguments());
  for (const nc::Program& chunk : chunks) run.feed(chunk);
  return run.finish();
}

/// Every slab goes to a worker, its packets one or two at a time.
VerifyReport by_packets(const std::vector<nc::Program>& chunks) {
  VerifyPlan plan(arguments());
  std::vector<VerifyPlan::Share> shares;
  for (const nc::Program& chunk : chunks)
    for (VerifyPlan::Share& share : plan.add(chunk)) shares.push_back(std::move(share));
  std::ranges::stable_sort(shares, {}, &VerifyPlan::Share::slab);
  const SlabWorker worker(plan.context());
  for (std::size_t k = 0; k < shares.size();) {
    const std::size_t slab = shares[k].slab, n = 1 + slab % 2;
    std::vector<std::span<const std::uint8_t>> packets;
    for (; k < shares.size() && shares[k].slab == slab && packets.size() < n; ++k)
      packets.emplace_back(shares[k].packet);
    plan.accept(slab, worker.run(plan.task(slab), packets), k == shares.size() || shares[k].slab != slab);
  }
  return plan.finish();
}

void expect_same(const VerifyReport& a, const VerifyReport& b) {
  ASSERT_EQ(a.findings.size(), b.findings.size());
  for (std::size_t k = 0; k < a.findings.size(); ++k) {
    const Finding &f = a.findings[k], &g = b.findings[k];
    EXPECT_EQ(f.message, g.message);
    EXPECT_EQ(std::tie(f.kind, f.member, f.fixture, f.tool, f.row, f.last_row, f.line, f.last_line, f.value, f.worst),
              std::tie(g.kind, g.member, g.fixture, g.tool, g.row, g.last_row, g.line, g.last_line, g.value, g.worst))
        << f.message;
    EXPECT_EQ(f.point, g.point) << f.message;
  }
  EXPECT_EQ(a.not_checked, b.not_checked);
  EXPECT_EQ(a.removed, b.removed);
  EXPECT_EQ(a.seconds, b.seconds);
  EXPECT_EQ(a.uncertain, b.uncertain);
  EXPECT_EQ(to_bytes(a.volume), to_bytes(b.volume));
}

class Threads {
 public:
  explicit Threads(int count) { base::set_thread_count(count); }
  ~Threads() { base::set_thread_count(std::nullopt); }
};

TEST(SlabRun, HasOneReportForAnySourceAndAnyNumberOfThreads) {
  const nc::Program program = mixed(220, 3);
  const VerifyReport whole = fed({program});
  std::set<Kind> kinds;
  for (const Finding& f : whole.findings) kinds.insert(f.kind);
  for (const Kind kind :
       {Kind::Rapid, Kind::Holder, Kind::Fixture, Kind::Gouge, Kind::Rest, Kind::Spindle, Kind::Machine, Kind::Unknown})
    EXPECT_TRUE(kinds.contains(kind)) << name_of(kind);
  EXPECT_EQ(whole.removed.size(), program.size());
  for (const int threads : {1, 2}) {
    const Threads some(threads);
    expect_same(whole, fed({program}));
    expect_same(whole, by_packets({program}));
    Verification verification(arguments());
    expect_same(whole, verification.run(program));
  }
}

/// The machine is asked chunk by chunk, so it may refuse a row of each.
void drop_machine(VerifyReport& report) {
  std::erase_if(report.findings, [](const Finding& f) { return f.kind == Kind::Machine; });
}

TEST(SlabRun, HasOneReportForAnySplitOfTheProgram) {
  const nc::Program program = mixed(test::cases(150, 3), 4);
  VerifyReport whole = fed({program});
  drop_machine(whole);
  for (const std::size_t rows : {1U, 7U, 60U}) {
    VerifyReport split = fed(chunks_of(program, rows)), sent = by_packets(chunks_of(program, rows));
    drop_machine(split), drop_machine(sent);
    expect_same(whole, split);
    expect_same(whole, sent);
  }
}

TEST(SlabRun, PacketsAreTheSameBytesOnAnyNumberOfThreads) {
  const nc::Program program = mixed(120, 5);
  std::vector<std::vector<std::uint8_t>> seen[2];
  for (const int threads : {1, 2}) {
    const Threads some(threads);
    auto& out = seen[threads - 1];
    VerifyPlan plan(arguments());
    const std::vector<VerifyPlan::Share> shares = plan.add(program);
    out.push_back(plan.context());
    const SlabWorker worker(plan.context());
    for (const VerifyPlan::Share& share : shares) {
      out.push_back(share.packet), out.push_back(plan.task(share.slab));
      const std::span<const std::uint8_t> moves = share.packet;
      out.push_back(worker.run(out.back(), {&moves, 1}));
    }
  }
  EXPECT_EQ(seen[0], seen[1]);
}

TEST(Verification, AfterEditsReportsWhatAFreshRunReports) {
  constexpr std::size_t kRows = test::cases(150, 3);
  const nc::Program first = mixed(kRows, 6);
  Verification verification(arguments());
  verification.run(first);
  std::vector<nc::Program> edits{trimmed(first, 0, kRows * 2 / 3), first, nc::Program(), mixed(kRows * 3 / 5, 7)};
  nc::Program moved;
  moved.tools = first.tools, moved.notes = first.notes;
  for (std::size_t row = 0; row < first.size(); ++row) {
    nc::Move move = first[row];
    if (row == kRows / 2) move.pose.tip.z += 1;
    moved.append(move);
  }
  edits.insert(edits.begin(), moved);
  for (const nc::Program& edit : edits) expect_same(verification.run(edit), fed({edit}));
  EXPECT_EQ(verification.run(edits.back()).stats.moves, 0U) << "nothing differs";
}

TEST(Verification, AfterAnErrorIsUnchanged) {
  const nc::Program good = mixed(60, 8);
  nc::Program bad = good;
  bad.append({{{1, 1, 1}, kUp}, 100, 8000, 9, 61});
  Verification verification(arguments());
  verification.run(good);
  EXPECT_NE(error_of([&] { verification.run(bad); }).find("the shape of tool 9 is unknown"), std::string::npos);
  const auto stop = [](double) { return false; };
  EXPECT_THROW(verification.run(mixed(60, 9), stop), Cancelled);
  const VerifyReport again = verification.run(good);
  EXPECT_EQ(again.stats.moves, 0U);
  expect_same(again, fed({good}));
}

TEST(SlabRun, OfAnEmptyProgramLeavesTheStockAndReportsSkippedBlocks) {
  nc::Program nothing;
  nothing.notes = {{"coordinates", 2, "coordinates were passed over"}};
  for (const VerifyReport& report : {fed({}), fed({nothing}), by_packets({nothing})}) {
    EXPECT_TRUE(report.findings.empty() || report.findings.front().kind == Kind::Rest);
    EXPECT_TRUE(report.removed.empty() && report.seconds.empty());
    EXPECT_EQ(to_bytes(report.volume), to_bytes(arguments().stock));
  }
  EXPECT_FALSE(fed({}).uncertain);
  EXPECT_TRUE(fed({nothing}).uncertain) << "rows may be missing";
}

TEST(SlabRun, RefusesAChunkThatBeginsElsewhereAndContinues) {
  const std::vector<nc::Program> chunks = chunks_of(mixed(40, 10), 20);
  SlabRun run(arguments());
  run.feed(chunks[0]);
  EXPECT_NE(
      error_of([&] { run.feed(chunks[0]); }).find("a chunk must begin with the row at which the one before ended"),
      std::string::npos);
  for (std::size_t k = 1; k < chunks.size(); ++k) run.feed(chunks[k]);
  expect_same(run.finish(), fed(chunks));
}

}  // namespace
}  // namespace riffler::verify::slab_run_test
