#include "fuzz/targets.hpp"

#include <algorithm>
#include <cmath>

#include "fuzz/repair.hpp"
#include "fuzz/samples.hpp"
#include "mesh/io/obj.hpp"
#include "mesh/io/ply.hpp"
#include "mesh/io/stl.hpp"
#include "nc/machine/description.hpp"
#include "nc/machine/machine.hpp"
#include "pen/arms/description.hpp"
#include "pen/haply/haply_message.hpp"
#include "pen/hid/hid_descriptor.hpp"
#include "pen/service/frame_reader.hpp"
#include "riffler/base/error.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/nc/program_file.hpp"
#include "riffler/nc/read/reader.hpp"
#include "riffler/session/journal_file.hpp"
#include "verify/slab_packets.hpp"

namespace riffler::fuzz {

namespace {

std::string_view text_of(View bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void require(bool good, const char* what) {
  if (!good) throw Broken(what);
}

/// Calls `read`, which may refuse the bytes with the errors that readers promise.
template <class Read>
void reading(const Read& read) {
  try {
    read();
  } catch (const FormatError& error) {
    require(std::string_view(error.what()).starts_with("fuzz"), "a message without the file's name");
  }
}

void check(const nc::Program& p) {
  for (std::size_t row = 0; row < p.size(); ++row) {
    require(geom::finite(p.poses()[row].tip), "a tip that is not finite");
    require(std::abs(glm::length(p.poses()[row].axis) - 1) < 1e-9, "an axis that is not of unit length");
    require(std::isfinite(p.feed()[row]) && p.feed()[row] >= 0, "an invalid feed");
    require(std::isfinite(p.spindle()[row]), "an invalid spindle speed");
  }
}

/// Reads with coarse chords and few turns, because long runs from one block, such as kilometres of arcs, are not
/// faults.
void nc(View bytes, const char* machine, bool skips) {
  reading([&] {
    nc::ReadOptions options{machine, {{"chord_tolerance", 0.1}}};
    if (options.machine != "apt") options.options["max_turns"] = 1000.0;
    if (options.machine != "apt" && !options.machine.starts_with("sinumerik")) {
      options.options["cutter_compensation"] = std::string("offset");
      options.options["tool_diameters"] = 1.0;
    }
    if (options.machine == "linuxcnc-xyzac") options.options["rot_point"] = std::vector<double>{0, 0, -50};
    if (skips) options.options["unknown"] = std::string("skip");
    check(parse_nc(text_of(bytes), "fuzz", options));
  });
}

template <Mesh (*From)(std::span<const std::uint8_t>, const std::string&)>
void mesh(View bytes) {
  reading([&] {
    const Mesh read = From(bytes, "fuzz");
    require(!read.empty(), "a mesh without triangles");
    validate(read);
  });
}

void program(View bytes) {
  reading([&] {
    const nc::Program read = nc::parse_program(bytes, "fuzz");
    check(read);
    require(nc::parse_program(to_bytes(read), "fuzz").size() == read.size(),
            "a program that differs after writing and reading");
  });
}

void volume(View bytes) {
  reading([&] {
    const Volume read = dexel::from_bytes(bytes, "fuzz");
    require(to_bytes(dexel::from_bytes(to_bytes(read), "fuzz")) == to_bytes(read),
            "a volume that differs after writing and reading");
  });
}

void journal(View bytes) {
  reading([&] {
    const session::Journal read = session::parse_journal(bytes, "fuzz");
    const session::Journal again = session::parse_journal(to_bytes(read), "fuzz");
    require(again.strokes().size() == read.strokes().size(), "a journal that differs after writing and reading");
  });
}

void machine(View bytes) {
  reading([&] { nc::machine_summary(text_of(bytes), "fuzz"); });
  reading([&] {
    try {
      nc::OptionReader options({}, "machine fuzz");
      describe_machine(text_of(bytes), "fuzz", "fuzz", options);
    } catch (const std::invalid_argument&) {  // a required option is missing
    }
  });
}

void pen(View bytes) {
  reading([&] { pen::pen_summary(text_of(bytes), "fuzz"); });
  reading([&] { pen::describe_pen(text_of(bytes), "fuzz", "fuzz"); });
}

void hid(View bytes) {
  try {
    pen::parse_descriptor(bytes);
  } catch (const std::invalid_argument&) {
  }
}

void haply(View bytes) {
  pen::HaplyMessage message;
  if (!pen::read_haply_message(text_of(bytes), message)) return;
  for (const pen::HaplyEntry& entry : message.all()) {
    require(!entry.id.empty() && entry.id.size() <= pen::kLongestHaplyName, "a device without a name");
    require(!entry.position || glm::length(*entry.position) <= 2, "a position out of any arm's reach");
    require(!entry.velocity || geom::finite(*entry.velocity), "a velocity that is not finite");
  }
}

/// Reads frames in two pieces, as from a socket.
void frames(View bytes) {
  pen::FrameReader reader(1000);
  for (std::size_t at = 0, piece = 7; at < bytes.size(); piece = 400) {
    const auto space = reader.space();
    const std::size_t n = std::min({piece, bytes.size() - at, space.size()});
    if (n == 0) break;
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), n, space.begin());
    reader.received(n);
    at += n;
    using Event = pen::FrameReader::Event;
    Event event = reader.next();
    for (; event == Event::Message || event == Event::Ping; event = reader.next())
      require(reader.payload().size() <= 1000, "a message longer than the bound");
    if (event != Event::More) break;
    require(!reader.space().empty(), "no room for a frame's end");
  }
}

/// Reads a packet, whose kind messages name.
template <class Read>
void packet(const Read& read) {
  try {
    read();
  } catch (const FormatError&) {
  } catch (const std::invalid_argument&) {  // an impossible tool
  }
}

void packets(View bytes) {
  packet([&] { verify::context_of(bytes); });
  packet([&] { verify::task_of(bytes); });
  packet([&] { verify::result_of(bytes); });
  packet([&] {
    verify::SlabMoves moves;
    add_moves(bytes, moves);
  });
}

std::vector<Bytes> nothing() {
  return {};
}

const Target kTargets[] = {
    {"rs274", [](View b) { nc(b, "tcp", b.size() % 2 == 1); }, &nothing, nullptr},
    {"rs274-axes", [](View b) { nc(b, b.size() % 2 == 1 ? "3-axis" : "linuxcnc-xyzac", false); }, &nothing, nullptr},
    {"heidenhain", [](View b) { nc(b, "heidenhain", b.size() % 2 == 1); }, &nothing, nullptr},
    {"sinumerik", [](View b) { nc(b, "sinumerik", b.size() % 2 == 1); }, &nothing, nullptr},
    {"apt", [](View b) { nc(b, "apt", b.size() % 2 == 1); }, &nothing, nullptr},
    {"stl", &mesh<&mesh::from_stl>, &stl_samples, nullptr},
    {"obj", &mesh<&mesh::from_obj>, &obj_samples, nullptr},
    {"ply", &mesh<&mesh::from_ply>, &ply_samples, nullptr},
    {"rvol", &volume, &volume_samples, &repair_volume},
    {"rprog", &program, &program_samples, &repair_program},
    {"rjournal", &journal, &journal_samples, &repair_journal},
    {"machine", &machine, &machine_samples, nullptr},
    {"pen", &pen, &pen_samples, nullptr},
    {"hid", &hid, &nothing, nullptr},
    {"haply", &haply, &nothing, nullptr},
    {"frames", &frames, &nothing, nullptr},
    {"packet", &packets, &packet_samples, &repair_packet},
};

}  // namespace

std::span<const Target> targets() {
  return kTargets;
}

const Target& target(std::string_view name) {
  std::string known;
  for (const Target& t : kTargets) {
    if (name == t.name) return t;
    known += std::string(known.empty() ? "" : ", ") + t.name;
  }
  throw std::invalid_argument("unknown target \"" + std::string(name) + "\"; known: " + known);
}

}  // namespace riffler::fuzz
