// Carves a groove into a block, writes its surface and its NC code, and verifies that code: one program with the main
// parts of Riffler's core. Prints each figure with its unit; lengths are in mm.
#include <cstdio>
#include <exception>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "riffler/marching/to_mesh.hpp"
#include "riffler/mesh/io/io.hpp"
#include "riffler/nc/cutter_path.hpp"
#include "riffler/nc/read/reader.hpp"
#include "riffler/nc/write/writer.hpp"
#include "riffler/plan/drop.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "riffler/verify/verification.hpp"

namespace {

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

void run() {
  // A block of 60 × 40 × 20 mm; rays along x, y and z, 0.25 mm apart.
  riffler::Volume stock = riffler::Volume::block({{{0, 0, 0}, {60, 40, 20}}, 0.25, "xyz"});
  const riffler::Volume block = stock;  // shares the content until one of them is cut

  // A ball end of Ø6 mm goes from end to end, as deep as its radius. A pose is a tip and an axis from tip to spindle.
  const riffler::Tool ball = riffler::cutters::ball(6, 30);
  const std::vector<riffler::Pose> poses{{{-5, 20, 17}, {0, 0, 1}}, {{65, 20, 17}, {0, 0, 1}}};
  const riffler::sweep::Cut cut = riffler::sweep::carve(stock, ball, poses);
  std::printf("removed %.3f mm3\n", sum(cut.removed));

  // The surface: closed, also after the file's float32.
  const riffler::Mesh part = riffler::marching::to_mesh(stock);
  riffler::mesh::write_mesh(part, "groove.stl");
  std::printf("triangles %zu\n", part.triangles.size());

  // The height at which a smaller ball rests in the groove.
  const riffler::plan::DropCutter drop(part, riffler::cutters::ball(4, 30));
  std::printf("rests %.4f mm\n", drop({30, 20, 0}).height);

  // The same cut as a program with approach and retract, written as NC code and read again.
  riffler::nc::CutterPath path;
  path.poses = poses, path.feed = {600}, path.spindle = 12000, path.tool = 1;
  const riffler::nc::Program program = riffler::nc::program_from_paths(std::vector{path}, {{1, ball}});
  riffler::nc::write_nc(program, "groove.ngc");
  riffler::nc::Program code = riffler::nc::read_nc("groove.ngc");
  std::printf("rows %zu\n", code.size());

  // What the code cuts out of the block, and whether anything collides or gouges the part.
  riffler::verify::VerifyArguments arguments{.stock = block};
  arguments.part = std::make_shared<const riffler::Mesh>(part);
  arguments.tools = {{1, ball}};
  const riffler::verify::VerifyReport report = riffler::verify::Verification(std::move(arguments)).run(code);
  for (const riffler::verify::Finding& finding : report.findings) std::printf("finding: %s\n", finding.message.c_str());
  std::printf("verified %.3f mm3\n", sum(report.removed));
  std::printf("findings %zu\n", report.findings.size());
}

}  // namespace

int main() {
  try {
    run();
  } catch (const std::exception& error) {  // names the argument and its row, or the file and its line
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
