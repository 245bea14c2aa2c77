#include "verify/slab_packets.hpp"

#include <bit>
#include <tuple>

#include "verify/tile_packets.hpp"

namespace riffler::verify {

namespace {

void put(PacketWriter& out, const std::string& text) {
  out.put_all(std::span<const char>(text));
}

std::string get_text(PacketReader& in) {
  const std::vector<char> text = in.get_all<char>();
  return {text.begin(), text.end()};
}

void put(PacketWriter& out, const Vec3& v) {
  for (int k = 0; k < 3; ++k) out.put(v[k]);
}

Vec3 get_vec3(PacketReader& in) {
  Vec3 v;
  for (int k = 0; k < 3; ++k) v[k] = in.get<double>();
  return v;
}

void put(PacketWriter& out, const std::vector<tool::Frustum>& pieces) {
  out.put(static_cast<std::uint64_t>(pieces.size()));
  for (const tool::Frustum& f : pieces)
    for (const double value : {f.z0, f.r0, f.z1, f.r1}) out.put(value);
}

std::vector<tool::Frustum> get_frusta(PacketReader& in) {
  std::vector<tool::Frustum> pieces(in.count());
  for (tool::Frustum& f : pieces)
    for (double* value : {&f.z0, &f.r0, &f.z1, &f.r1}) *value = in.get<double>();
  return pieces;
}

/// The properties of a tool that determine where it cuts and touches.
void put(PacketWriter& out, const Tool& tool) {
  const std::vector<tool::ProfileSegment>& segments = tool.profile().segments();
  out.put(static_cast<std::uint64_t>(segments.size()));
  for (const tool::ProfileSegment& s : segments) {
    const Vec2 centre = s.centre.value_or(Vec2(0));
    out.put(static_cast<std::uint8_t>(s.centre.has_value()));
    for (const double value : {s.to.x, s.to.y, centre.x, centre.y}) out.put(value);
  }
  put(out, tool.shank()), put(out, tool.holder());
}

Tool get_tool(PacketReader& in) {
  std::vector<tool::ProfileSegment> segments(in.count());
  for (tool::ProfileSegment& s : segments) {
    const bool arc = in.get<std::uint8_t>() != 0;
    Vec2 centre;
    for (double* value : {&s.to.x, &s.to.y, &centre.x, &centre.y}) *value = in.get<double>();
    if (arc) s.centre = centre;
  }
  const Tool cutter("profile", {}, tool::Profile(std::move(segments)));
  const std::vector<tool::Frustum> shank = get_frusta(in), holder = get_frusta(in);
  const Tool with_shank = shank.empty() ? cutter : cutter.with_shank(shank);
  return holder.empty() ? with_shank : with_shank.with_holder(holder);
}

void put(PacketWriter& out, const Mesh& mesh) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Vec3i) == 3 * sizeof(int));
  out.put_all(std::span(reinterpret_cast<const double*>(mesh.vertices.data()), 3 * mesh.vertices.size()));
  out.put_all(std::span(reinterpret_cast<const int*>(mesh.triangles.data()), 3 * mesh.triangles.size()));
}

Mesh get_mesh(PacketReader& in) {
  const std::vector<double> at = in.get_all<double>();
  const std::vector<int> corners = in.get_all<int>();
  if (at.size() % 3 != 0 || corners.size() % 3 != 0) in.fail("an invalid mesh");
  Mesh mesh;
  for (std::size_t k = 0; k < at.size(); k += 3) mesh.vertices.emplace_back(at[k], at[k + 1], at[k + 2]);
  for (std::size_t k = 0; k < corners.size(); k += 3)
    mesh.triangles.emplace_back(corners[k], corners[k + 1], corners[k + 2]);
  return mesh;
}

}  // namespace

std::vector<std::uint8_t> to_packet(const SlabContext& context) {
  PacketWriter out(PacketKind::Context);
  out.put(static_cast<std::uint64_t>(context.frames.size()));
  for (const dexel::Frame& frame : context.frames) {
    put(out, frame.box.lower), put(out, frame.box.upper), put(out, frame.directions);
    out.put(frame.pitch);
  }
  out.put(static_cast<std::uint64_t>(context.tools.size()));
  for (const Tool& tool : context.tools) put(out, tool);
  for (const double value : {context.reach, context.tolerance, context.gouge_tolerance, context.top}) out.put(value);
  out.put(static_cast<std::uint8_t>(context.part != nullptr));
  if (context.part) put(out, *context.part);
  return out.finish();
}

SlabContext context_of(std::span<const std::uint8_t> packet) {
  PacketReader in(packet, PacketKind::Context);
  SlabContext context;
  context.frames.resize(in.count());
  for (dexel::Frame& frame : context.frames) {
    frame.box.lower = get_vec3(in), frame.box.upper = get_vec3(in), frame.directions = get_text(in);
    frame.pitch = in.get<double>();
  }
  for (std::size_t n = in.count(); n > 0; --n) context.tools.push_back(get_tool(in));
  for (double* value : {&context.reach, &context.tolerance, &context.gouge_tolerance, &context.top})
    *value = in.get<double>();
  if (in.get<std::uint8_t>() != 0) context.part = std::make_shared<const Mesh>(get_mesh(in));
  in.finish();
  return context;
}

std::vector<std::uint8_t> to_packet(const SlabTask& task) {
  PacketWriter out(PacketKind::Task);
  out.put(task.fixture);
  out.put(static_cast<std::uint64_t>(task.slab.grid));
  for (const int side : {task.slab.u0, task.slab.u1, task.slab.v0, task.slab.v1}) out.put(side);
  out.put(static_cast<std::uint8_t>(task.probed));
  out.put(task.strikes);
  put_tiles(out, task.tiles), put_tiles(out, task.part);
  return out.finish();
}

SlabTask task_of(std::span<const std::uint8_t> packet) {
  PacketReader in(packet, PacketKind::Task);
  SlabTask task;
  task.fixture = in.get<std::int32_t>();
  task.slab.grid = static_cast<std::size_t>(in.get<std::uint64_t>());
  for (int* side : {&task.slab.u0, &task.slab.u1, &task.slab.v0, &task.slab.v1}) *side = in.get<int>();
  task.probed = in.get<std::uint8_t>() != 0;
  task.strikes = in.get<std::uint64_t>();
  task.tiles = get_tiles(in), task.part = get_tiles(in);
  in.finish();
  return task;
}

namespace {

/// Poses column by column: a path with a constant axis has three constant columns.
constexpr double Vec3::* kComponents[] = {&Vec3::x, &Vec3::y, &Vec3::z};

bool identical(const Pose& a, const Pose& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;  // −0 and 0 count as different here
}

}  // namespace

std::vector<std::uint8_t> to_packet(const Moves& moves, std::span<const std::uint32_t> chosen) {
  std::vector<std::uint64_t> rows;
  std::vector<std::uint32_t> keys;  // per move: tool, rapid flag, flag for a start at the previous end
  std::vector<Pose> poses;
  for (const std::uint32_t i : chosen) {
    const bool joined = !poses.empty() && identical(poses.back(), moves.from(i));
    rows.push_back(static_cast<std::uint64_t>(moves.row(i)));
    keys.push_back(moves.tool(i) << 2 | static_cast<unsigned>(moves.rapid(i)) << 1 | static_cast<unsigned>(joined));
    if (!joined) poses.push_back(moves.from(i));
    poses.push_back(moves.to(i));
  }
  PacketWriter out(PacketKind::Moves);
  out.put(static_cast<std::uint64_t>(chosen.size()));
  out.put(static_cast<std::uint64_t>(poses.size()));
  out.columns([&](base::PlaneWriter& planes) {
    planes.column(rows), planes.column(keys);
    std::vector<std::uint64_t> column(poses.size());
    for (Vec3 Pose::* half : {&Pose::tip, &Pose::axis})
      for (double Vec3::* component : kComponents) {
        for (std::size_t k = 0; k < poses.size(); ++k)
          column[k] = std::bit_cast<std::uint64_t>(poses[k].*half.*component);
        planes.column(column);
      }
  });
  return out.finish();
}

void add_moves(std::span<const std::uint8_t> packet, SlabMoves& moves) {
  PacketReader in(packet, PacketKind::Moves);
  const std::size_t n = in.count(), m = in.count();
  std::vector<std::uint64_t> rows;
  std::vector<std::uint32_t> keys;
  std::vector<Pose> poses(m);
  in.columns([&](base::PlaneReader& planes) {
    rows = planes.column64(n), keys = planes.column32(n);
    for (Vec3 Pose::* half : {&Pose::tip, &Pose::axis})
      for (double Vec3::* component : kComponents) {
        const std::vector<std::uint64_t> column = planes.column64(m);
        for (std::size_t k = 0; k < m; ++k) poses[k].*half.*component = std::bit_cast<double>(column[k]);
      }
  });
  in.finish();
  std::size_t at = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool joined = (keys[i] & 1) != 0;
    if (joined ? at == 0 : ++at > m) in.fail("moves without poses");
    if (at >= m) in.fail("moves without poses");
    moves.row.push_back(static_cast<std::int64_t>(rows[i]));
    moves.tool.push_back(keys[i] >> 2), moves.rapid.push_back(keys[i] >> 1 & 1);
    moves.poses.push_back(poses[at - 1]), moves.poses.push_back(poses[at]);
    ++at;
  }
  if (at != m) in.fail("poses without moves");
}

namespace {

auto counters(auto& s) {
  return std::tie(s.moves, s.slabs, s.slabs_kept, s.snapshots_used, s.probes, s.probed_moves, s.bisections, s.skipped);
}

void put(PacketWriter& out, const Event& e) {
  out.put(static_cast<std::uint8_t>(e.kind)), out.put(static_cast<std::uint8_t>(e.member)), out.put(e.fixture);
  out.put(e.row), out.put(e.value), out.put(e.worst);
  put(out, e.point);
}

Event get_event(PacketReader& in) {
  Event e{};
  const auto kind = in.get<std::uint8_t>(), member = in.get<std::uint8_t>();
  if (kind > static_cast<int>(Kind::Unknown) || member > static_cast<int>(Member::Beyond)) in.fail("an unknown event");
  e.kind = static_cast<Kind>(kind), e.member = static_cast<Member>(member), e.fixture = in.get<std::int32_t>();
  e.row = in.get<std::int64_t>(), e.value = in.get<double>(), e.worst = in.get<double>();
  e.point = get_vec3(in);
  return e;
}

}  // namespace

std::vector<std::uint8_t> to_packet(const SlabResult& result) {
  PacketWriter out(PacketKind::Result);
  put_tiles(out, result.tiles);
  out.put(static_cast<std::uint64_t>(result.report.removed.size()));
  out.columns([&](base::PlaneWriter& planes) {
    std::vector<std::uint64_t> rows, values;
    for (const auto& [row, taken] : result.report.removed) {
      rows.push_back(static_cast<std::uint64_t>(row));
      values.push_back(std::bit_cast<std::uint64_t>(taken));
    }
    planes.column(rows), planes.column(values);
  });
  out.put(static_cast<std::uint64_t>(result.report.events.size()));
  for (const Event& e : result.report.events) put(out, e);
  out.put(result.report.strikes);
  std::apply([&](const auto&... counter) { (out.put(counter), ...); }, counters(result.stats));
  return out.finish();
}

SlabResult result_of(std::span<const std::uint8_t> packet) {
  PacketReader in(packet, PacketKind::Result);
  SlabResult result;
  result.tiles = get_tiles(in);
  const std::size_t n = in.count();
  in.columns([&](base::PlaneReader& planes) {
    const std::vector<std::uint64_t> rows = planes.column64(n), values = planes.column64(n);
    for (std::size_t k = 0; k < n; ++k)
      result.report.removed.emplace_back(static_cast<std::int64_t>(rows[k]), std::bit_cast<double>(values[k]));
  });
  for (std::size_t k = in.count(); k > 0; --k) result.report.events.push_back(get_event(in));
  result.report.strikes = in.get<std::uint64_t>();
  std::apply([&](auto&... counter) { ((counter = in.get<std::uint64_t>()), ...); }, counters(result.stats));
  in.finish();
  return result;
}

}  // namespace riffler::verify
