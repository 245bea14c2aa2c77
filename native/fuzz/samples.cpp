#include "fuzz/samples.hpp"

#include "mesh/io/obj.hpp"
#include "mesh/io/ply.hpp"
#include "mesh/io/stl.hpp"
#include "nc/machine/shipped_machines.hpp"
#include "pen/arms/shipped_pens.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/nc/program_file.hpp"
#include "riffler/session/journal_file.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "verify/slab_packets.hpp"

namespace riffler::fuzz {

namespace {

const Vec3 kUp(0, 0, 1);

Mesh tetrahedron(double size) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

Volume carved(const char* directions) {
  Volume volume = Volume::block({{{0, 0, 0}, {6, 5, 3}}, 0.5, directions});
  sweep::carve(volume, cutters::ball(2, 20), std::vector<Pose>{{{1, 1, 2}, kUp}, {{5, 4, 1.5}, kUp}});
  return volume;
}

Samples texts(std::span<const base::ShippedText> all) {
  Samples out;
  for (const base::ShippedText& one : all) out.emplace_back(one.toml.begin(), one.toml.end());
  return out;
}

}  // namespace

Samples stl_samples() {
  return {to_stl(tetrahedron(1))};
}

Samples obj_samples() {
  return {to_obj(tetrahedron(1))};
}

Samples ply_samples() {
  return {to_ply(tetrahedron(1)), to_ply(tetrahedron(0.1))};  // float and double
}

Samples volume_samples() {
  return {to_bytes(carved("z")), to_bytes(carved("xyz")), to_bytes(Volume({{{0, 0, 0}, {40, 1, 1}}, 1, "x"}))};
}

Samples program_samples() {
  nc::Program program;
  for (int k = 0; k < 5; ++k)
    program.append({{{k * 1.5, 2.0 - k, 3}, kUp}, k == 0 ? 0.0 : 600.0, 9000, 1, k + 1, k == 0});
  program.provenance = {{"source", "part.ngc"}};
  program.tools.emplace(1, cutters::fillet(6, 1, 30));
  return {to_bytes(program), to_bytes(nc::Program())};
}

Samples journal_samples() {
  session::Journal journal;
  journal.add_note("by", "a sample");
  journal.set_stock({{{0, 0, 0}, {6, 5, 3}}, 0.5, "z", "", ""});
  journal.add_tool(1, R"({"kind": "ball", "diameter": 2, "length": 20})");
  session::JournalStroke stroke;
  stroke.tool = 1, stroke.tolerance = 0.01, stroke.name = "first";
  stroke.poses = {{{1, 1, 2}, kUp}, {{5, 4, 1.5}, kUp}};
  stroke.times = {0, 0.5};
  journal.add_stroke(stroke);
  journal.undo(1);
  return {to_bytes(journal), to_bytes(session::Journal())};
}

Samples packet_samples() {
  const Volume volume = carved("z");
  const verify::Slab slab = verify::slabs_of(volume).front();
  verify::SlabContext context;
  context.frames = {volume.frame()};
  context.tools = {cutters::ball(2, 20)};
  context.reach = 20, context.tolerance = 0.01, context.gouge_tolerance = 0.05, context.top = 10;
  context.part = std::make_shared<Mesh>(tetrahedron(2));
  const verify::SlabTask task{-1, slab, true, 3, tiles_of(volume.grids()[0], slab), {}};
  verify::SlabResult result{tiles_of(volume.grids()[0], slab), {}, {}};
  result.report.removed = {{1, 0.5}};
  result.report.events = {{verify::Kind::Rapid, verify::Member::Cutter, -1, 4, 2, 3, Vec3(0)}};
  return {to_packet(context), to_packet(task), to_packet(result)};
}

Samples machine_samples() {
  return texts(nc::shipped_machines());
}

Samples pen_samples() {
  return texts(pen::shipped_pens());
}

}  // namespace riffler::fuzz
