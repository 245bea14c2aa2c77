// Reads .rvol files.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/io.hpp"
#include "base/path_text.hpp"
#include "base/planes.hpp"
#include "dexel/file/format.hpp"
#include "riffler/base/error.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/dexel/file/file.hpp"

namespace riffler::dexel {

namespace {

using namespace rvol;
using TilePtr = std::shared_ptr<const Tile>;

struct Header {
  Frame frame;
  std::uint64_t spans;
  std::uint32_t tiles;
};

/// One chunk as described by its header; `payload` begins at byte `at` + kChunkHeader of the file.
struct Chunk {
  std::size_t grid;
  std::uint32_t kind, items, spans;
  std::size_t at;
  std::span<const std::uint8_t> payload;
};

class Reader {
 public:
  Reader(std::span<const std::uint8_t> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Volume run(const Progress& progress) const;

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& what) const {
    throw FormatError(name_, "byte " + std::to_string(at), what);
  }
  Header header() const;
  void check_affordable(const Header& header) const;
  std::vector<Chunk> chunks(std::size_t grids, const Header& header) const;
  Chunk chunk(std::size_t at, std::size_t grid) const;
  std::vector<std::uint32_t> map(const Chunk& chunk, const Grid& grid) const;
  std::vector<TilePtr> tiles(const Chunk& chunk, const Grid& grid) const;
  TilePtr tile(const Chunk& chunk, const Grid& grid, std::span<const std::uint32_t> counts, std::size_t first,
               const std::vector<std::uint64_t>& near, const std::vector<std::uint64_t>& far,
               const std::array<std::vector<std::uint16_t>, 4>& normals) const;
  void place(Grid& grid, std::size_t t, const TilePtr& tile) const;

  std::span<const std::uint8_t> bytes_;
  const std::string& name_;
};

Header Reader::header() const {
  if (bytes_.size() < kMagic.size() || !std::equal(kMagic.begin(), kMagic.end(), bytes_.begin()))
    fail(0, "not a .rvol file (wrong first eight bytes)");
  if (bytes_.size() < kHeader) fail(bytes_.size(), "the file ends within its header");
  const auto version = base::get<std::uint32_t>(bytes_, 8);
  if (version != kVersion)
    fail(8, "version " + std::to_string(version) + "; this program reads version " + std::to_string(kVersion));
  if (base::get<std::uint32_t>(bytes_, kHeader - 4) != base::checksum(bytes_.first(kHeader - 4)))
    fail(kHeader - 4, "the header's checksum does not match");
  const auto length = base::get<std::uint64_t>(bytes_, 16);
  if (bytes_.size() < length)
    fail(bytes_.size(), "the file ends here, but should have " + std::to_string(length) + " bytes");
  if (bytes_.size() > length) fail(length, "there is data after the file's end");

  Header header;
  const auto directions = base::get<std::array<char, 4>>(bytes_, 12);
  header.frame.directions.assign(directions.begin(), std::find(directions.begin(), directions.end(), '\0'));
  for (int k = 0; k < 3; ++k) {
    header.frame.box.lower[k] = base::get<double>(bytes_, 24 + 8 * k);
    header.frame.box.upper[k] = base::get<double>(bytes_, 48 + 8 * k);
  }
  header.frame.pitch = base::get<double>(bytes_, 72);
  header.spans = base::get<std::uint64_t>(bytes_, 80);
  header.tiles = base::get<std::uint32_t>(bytes_, 88);
  return header;
}

/// Checks before any allocation that a file of this length can hold this many tiles and spans.
void Reader::check_affordable(const Header& header) const {
  const Frame& frame = header.frame;
  const double most = static_cast<double>(base::kMaxDeflated) * static_cast<double>(bytes_.size());
  double places = 0;
  for (const Axis axis : parse_directions(frame.directions)) {
    const Vec3 size = to_local(axis, frame.box).size() / frame.pitch;
    places += std::ceil(std::max(1.0, std::round(size.x)) / kTileSide) *
              std::ceil(std::max(1.0, std::round(size.y)) / kTileSide);
  }
  // An entry of the map takes four planes, a span sixteen or more, a tile's counts four of 1024 bytes.
  if (!(places * 4 <= most)) fail(24, "the box has more tiles than a file of this length can describe");
  const auto spans = static_cast<double>(header.spans), tiles = static_cast<double>(header.tiles);
  if (!(spans * 16 + tiles * 4 * kTileRays <= most))
    fail(80, "more spans or tiles than a file of this length can hold");
  const double needed = spans * sizeof(Span) + tiles * sizeof(Tile);
  if (needed > available_memory()) fail(80, "its spans need more memory than is free");
}

Chunk Reader::chunk(std::size_t at, std::size_t grid) const {
  if (bytes_.size() - at < kChunkHeader) fail(at, "the file ends where a chunk should begin");
  const auto head = bytes_.subspan(at);
  Chunk chunk{
      grid, base::get<std::uint32_t>(head, 0), base::get<std::uint32_t>(head, 4), base::get<std::uint32_t>(head, 8), at,
      {}};
  const auto length = base::get<std::uint64_t>(head, 12);
  if (length > head.size() - kChunkHeader) fail(at + 12, "the chunk is longer than the rest of the file");
  chunk.payload = head.subspan(kChunkHeader, length);
  return chunk;
}

/// Reads the chunk headers; payloads are read later, in parallel.
std::vector<Chunk> Reader::chunks(std::size_t grids, const Header& header) const {
  std::vector<Chunk> all;
  std::size_t at = kHeader, maps = 0;
  std::uint64_t spans = 0, tiles = 0;
  while (at < bytes_.size()) {
    const auto kind = bytes_.size() - at < kChunkHeader ? 0 : base::get<std::uint32_t>(bytes_, at);
    if (kind == kMap) ++maps;
    if (maps == 0 || maps > grids) fail(at, "a chunk that belongs to no grid");
    all.push_back(chunk(at, maps - 1));
    const Chunk& last = all.back();
    if (kind != kMap && kind != kTiles) fail(at, "a chunk of unknown kind");
    if (kind == kTiles) {
      if (last.items == 0 || last.items > kChunkTiles) fail(at + 4, "a chunk holds 1 to 64 tiles");
      spans += last.spans, tiles += last.items;
    }
    at += kChunkHeader + last.payload.size();
  }
  if (maps != grids) fail(at, "the file ends before its last grid");
  if (spans != header.spans || tiles != header.tiles)
    fail(80, "the header announces " + std::to_string(header.spans) + " spans in " + std::to_string(header.tiles) +
                 " tiles, the chunks hold " + std::to_string(spans) + " in " + std::to_string(tiles));
  return all;
}

std::vector<std::uint32_t> Reader::map(const Chunk& chunk, const Grid& grid) const {
  if (chunk.items != grid.tile_count() || chunk.spans != 0)
    fail(chunk.at + 4, "the map has " + std::to_string(chunk.items) + " places, the grid " +
                           std::to_string(grid.tile_count()) + " tiles");
  base::PlaneReader in(chunk.payload, chunk.at + kChunkHeader, name_);
  std::vector<std::uint32_t> places = in.column32(chunk.items);
  in.finish();
  std::uint32_t most = 0;
  for (const std::uint32_t place : places) {
    if (place > most + 1) fail(chunk.at, "the map's tiles are not in order of first appearance");
    most = std::max(most, place);
  }
  return places;
}

std::vector<TilePtr> Reader::tiles(const Chunk& chunk, const Grid& grid) const {
  base::PlaneReader in(chunk.payload, chunk.at + kChunkHeader, name_);
  const std::vector<std::uint32_t> counts = in.column32(std::size_t{chunk.items} * kTileRays);
  std::uint64_t sum = 0;
  for (const std::uint32_t count : counts) sum += count;
  if (sum != chunk.spans) fail(chunk.at + 8, "the rays' span counts do not add up to the chunk's");
  const std::vector<std::uint64_t> near = in.column64(chunk.spans), far = in.column64(chunk.spans);
  std::array<std::vector<std::uint16_t>, 4> normals;
  if (grid.has_normals())
    for (auto& component : normals) component = in.column16(chunk.spans);
  in.finish();

  std::vector<TilePtr> result;
  std::size_t first = 0;
  for (std::uint32_t k = 0; k < chunk.items; ++k) {
    result.push_back(tile(chunk, grid, std::span(counts).subspan(k * kTileRays, kTileRays), first, near, far, normals));
    first += result.back()->spans.size();
  }
  return result;
}

TilePtr Reader::tile(const Chunk& chunk, const Grid& grid, std::span<const std::uint32_t> counts, std::size_t first,
                     const std::vector<std::uint64_t>& near, const std::vector<std::uint64_t>& far,
                     const std::array<std::vector<std::uint16_t>, 4>& normals) const {
  const double lower = grid.box().lower.z, upper = grid.box().upper.z;
  const auto component = [&](std::size_t which, std::size_t k) { return static_cast<std::int16_t>(normals[which][k]); };
  TileBuilder builder(grid.has_normals());
  std::size_t k = first;
  for (const std::uint32_t count : counts) {
    for (std::uint32_t s = 0; s < count; ++s, ++k) {
      const Span span{std::bit_cast<double>(near[k]), std::bit_cast<double>(far[k])};
      // NaN fails these comparisons too, and infinities lie outside the box.
      if (!(span.near < span.far && span.near >= lower && span.far <= upper))
        fail(chunk.at, "a span of the chunk is reversed, empty or outside the box");
      if (s > 0 && !(std::bit_cast<double>(far[k - 1]) < span.near))
        fail(chunk.at, "spans of a ray overlap or are out of order");
      SpanNormals n;
      if (grid.has_normals()) n = {{component(0, k), component(1, k)}, {component(2, k), component(3, k)}};
      builder.add(span, n);
    }
    builder.next_ray();
  }
  if (k == first) fail(chunk.at, "an empty tile is stored");
  return builder.finish();
}

/// Stores the tile, unless it has material on rays outside the grid.
void Reader::place(Grid& grid, std::size_t t, const TilePtr& tile) const {
  const int tu = static_cast<int>(t) / grid.tiles_v(), tv = static_cast<int>(t) % grid.tiles_v();
  const int rows = grid.nu() - tu * kTileSide, columns = grid.nv() - tv * kTileSide;
  if (rows < kTileSide || columns < kTileSide)
    for (int r = 0; r < kTileRays; ++r)
      if (!tile->ray(r).empty() && (r / kTileSide >= rows || r % kTileSide >= columns))
        fail(kHeader, "a tile at the border has material beyond it");
  grid.set_tile(t, tile);
}

Volume Reader::run(const Progress& progress) const {
  const Header header = this->header();
  Volume volume = [&] {
    try {
      check_affordable(header);
      return Volume(header.frame);
    } catch (const std::invalid_argument& e) {
      fail(12, e.what());
    }
  }();
  std::vector<Grid>& grids = volume.grids();
  const std::vector<Chunk> all = chunks(grids.size(), header);

  std::vector<std::vector<std::uint32_t>> maps(grids.size());
  std::vector<std::vector<TilePtr>> read(all.size());
  base::parallel_for(
      all.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const Chunk& chunk = all[k];
          if (base::get<std::uint32_t>(bytes_, chunk.at + 20) !=
              base::checksum(bytes_.subspan(chunk.at, 20), chunk.payload))
            fail(chunk.at, "the chunk's checksum does not match");
          if (chunk.kind == kMap)
            maps[chunk.grid] = map(chunk, grids[chunk.grid]);
          else
            read[k] = tiles(chunk, grids[chunk.grid]);
        }
      },
      progress);

  std::vector<std::vector<TilePtr>> stored(grids.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    for (TilePtr& tile : read[k]) stored[all[k].grid].push_back(std::move(tile));
  for (std::size_t g = 0; g < grids.size(); ++g) {
    std::uint32_t used = 0;
    for (const std::uint32_t place : maps[g]) used = std::max(used, place);
    if (used != stored[g].size())
      fail(kHeader,
           "the map uses " + std::to_string(used) + " tiles, but " + std::to_string(stored[g].size()) + " are stored");
    for (std::size_t t = 0; t < maps[g].size(); ++t)
      if (maps[g][t] > 0) place(grids[g], t, stored[g][maps[g][t] - 1]);
  }
  return volume;
}

}  // namespace

Volume from_bytes(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress) {
  return Reader(bytes, name).run(progress);
}

Volume load(const std::filesystem::path& path, const Progress& progress) {
  return from_bytes(base::read_file(path), base::file_name(path), progress);
}

}  // namespace riffler::dexel
