#include "riffler/dexel/volume.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/memory.hpp"
#include "riffler/base/check.hpp"

namespace riffler::dexel {

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

std::string sides(const Vec3& size) {
  return base::in_figures(size.x) + " × " + base::in_figures(size.y) + " × " + base::in_figures(size.z) + " mm";
}

double longest(const Vec3& size) {
  return std::max({size.x, size.y, size.z});
}

void check_box(const Box3& box) {
  const char* const names = "xyz";
  for (int k = 0; k < 3; ++k) {
    const double lower = box.lower[k], upper = box.upper[k];
    const std::string along = std::string(" along ") + names[k];
    for (const auto& [name, x] : {std::pair{"lower", lower}, std::pair{"upper", upper}})
      if (!std::isfinite(x))
        throw std::invalid_argument(name + (" must be finite, not " + base::in_figures(x)) + along);
    if (!(lower < upper))
      throw std::invalid_argument("lower must be less than upper;" + along + " they are " + base::in_figures(lower) +
                                  " and " + base::in_figures(upper) + " mm");
    if (!(upper - lower <= base::kMaxBox))
      throw std::invalid_argument("the box is " + base::in_figures(upper - lower) + " mm long" + along +
                                  ", and may be " + base::in_figures(base::kMaxBox) +
                                  " mm at most: give its size in millimetres");
  }
}

void check(const Frame& frame) {
  parse_directions(frame.directions);
  check_box(frame.box);
  const double pitch = frame.pitch;
  if (!std::isfinite(pitch) || !(pitch > 0))
    throw std::invalid_argument("pitch must be a positive length in mm, not " + base::in_figures(pitch));
  const Vec3 size = frame.box.size();
  if (pitch > longest(size))
    throw std::invalid_argument("pitch " + base::in_figures(pitch) + " mm is longer than every side of the box, " +
                                sides(size) + ": take a finer pitch");
  if (longest(glm::max(glm::abs(frame.box.lower), glm::abs(frame.box.upper))) > 1e15 * pitch)
    throw std::invalid_argument("pitch " + base::in_figures(pitch) +
                                " mm is too fine for coordinates as large as the box's, whose rays would coincide: " +
                                "take a coarser pitch, or move the box to the origin");
  const double bytes = estimated_bytes(frame), free = available_memory();
  if (bytes > free || longest(size) > 1e9 * pitch)
    throw std::invalid_argument("pitch " + base::in_figures(pitch) + " mm needs " + base::in_bytes(bytes) +
                                " for the rays of this box, " + sides(size) + ", and " + base::in_bytes(free) +
                                " are free: take a coarser pitch or a smaller box");
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

Volume Volume::block(const Frame& frame) {
  Volume volume(frame);
  for (Grid& grid : volume.grids_) grid.fill();
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

}  // namespace riffler::dexel
