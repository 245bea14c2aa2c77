#include "dexel/volume.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace riffler {

double available_memory() {
  std::ifstream info("/proc/meminfo");
  for (std::string key; info >> key;) {
    double kilobytes = 0;
    if (key == "MemAvailable:" && info >> kilobytes) return kilobytes * 1024;
    info.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return std::numeric_limits<double>::infinity();
}

namespace {

void check(const Frame& frame) {
  parse_directions(frame.directions);
  const char* names = "xyz";
  for (int k = 0; k < 3; ++k) {
    if (!std::isfinite(frame.box.lower[k]) || !std::isfinite(frame.box.upper[k]))
      throw std::invalid_argument(std::string("lower and upper must be finite; ") + names[k] + " is not");
    if (!(frame.box.lower[k] < frame.box.upper[k]))
      throw std::invalid_argument(std::string("lower must be less than upper; it is not in ") + names[k]);
  }
  if (!std::isfinite(frame.pitch) || !(frame.pitch > 0))
    throw std::invalid_argument("pitch must be a positive length in mm");
  const Vec3 largest = glm::max(glm::abs(frame.box.lower), glm::abs(frame.box.upper));
  if (std::max({largest.x, largest.y, largest.z}) > 1e15 * frame.pitch)
    throw std::invalid_argument("pitch is too fine for coordinates as large as the box's: rays would coincide");
  const double bytes = estimated_bytes(frame), free = available_memory();
  const Vec3 sides = frame.box.size() / frame.pitch;
  if (bytes > free || std::max({sides.x, sides.y, sides.z}) > 1e9) {
    std::ostringstream text;
    text.precision(0);
    text << std::fixed << "pitch " << std::defaultfloat << frame.pitch << " mm needs " << std::fixed << bytes
         << " bytes for the rays of this box, and " << free << " are free; take a coarser pitch or a smaller box";
    throw std::invalid_argument(text.str());
  }
}

}  // namespace

std::vector<Axis> parse_directions(const std::string& directions) {
  if (directions == "xyz") return {Axis::X, Axis::Y, Axis::Z};
  if (directions == "x") return {Axis::X};
  if (directions == "y") return {Axis::Y};
  if (directions == "z") return {Axis::Z};
  throw std::invalid_argument("directions must be \"z\" or \"xyz\" (or \"x\", \"y\"), not \"" + directions + "\"");
}

double estimated_bytes(const Frame& frame) {
  const std::vector<Axis> axes = parse_directions(frame.directions);
  const double per_ray = sizeof(Span) + sizeof(std::uint32_t) + (axes.size() == 3 ? sizeof(SpanNormals) : 0);
  double bytes = 0;
  for (const Axis axis : axes) {
    const Vec3 size = to_local(axis, frame.box).size();
    bytes +=
        std::max(1.0, std::round(size.x / frame.pitch)) * std::max(1.0, std::round(size.y / frame.pitch)) * per_ray;
  }
  return bytes;
}

Volume::Volume(const Frame& frame) : frame_(frame), revision_(next_revision()) {
  check(frame);
  const std::vector<Axis> axes = parse_directions(frame.directions);
  for (const Axis axis : axes) grids_.emplace_back(axis, frame.box, frame.pitch, axes.size() == 3);
}

namespace {

void fill(Grid& grid) {
  const Span span{grid.box().lower.z, grid.box().upper.z};
  const Vec3 along = to_world(grid.axis(), Vec3(0, 0, 1));
  const SpanNormals normals{PackedNormal::pack(-along), PackedNormal::pack(along)};
  // Tiles of equal shape are one tile until they are cut: inner, last row, last column, corner.
  std::shared_ptr<const Tile> shared[2][2];
  for (int a = 0; a < grid.tiles_u(); ++a)
    for (int b = 0; b < grid.tiles_v(); ++b) {
      const std::size_t t = grid.tile_index(a, b);
      auto& tile = shared[a == grid.tiles_u() - 1][b == grid.tiles_v() - 1];
      if (tile) {
        grid.set_tile(t, tile);
        continue;
      }
      grid.fill_tile(t, [&](int, int, TileBuilder& builder) { builder.add(span, normals); });
      tile = grid.shared_tile(t);
    }
}

}  // namespace

Volume Volume::block(const Frame& frame) {
  Volume volume(frame);
  for (Grid& grid : volume.grids_) fill(grid);
  return volume;
}

const Grid* Volume::grid(Axis axis) const {
  for (const Grid& g : grids_)
    if (g.axis() == axis) return &g;
  return nullptr;
}

const Grid& Volume::reference() const {
  const Grid* z = grid(Axis::Z);
  return z ? *z : grids_.front();
}

std::size_t Volume::nbytes() const {
  std::size_t bytes = sizeof(Volume);
  for (const Grid& g : grids_) bytes += g.nbytes();
  return bytes;
}

void Volume::restore(const Volume& snapshot) {
  if (!(frame_ == snapshot.frame_)) throw std::invalid_argument("the snapshot belongs to a volume of another grid");
  grids_ = snapshot.grids_;
  revision_ = snapshot.revision_;
}

}  // namespace riffler
