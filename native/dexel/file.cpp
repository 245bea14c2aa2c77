// The .rvol file, all numbers little-endian:
//
//   header (96 bytes)  magic 8 | version u32 | directions, 4 characters | length of the file u64 | lower, upper, pitch
//                      7 × f64 | spans stored u64 | tiles stored u32 | CRC-32 of what is before it u32
//   then, for each grid in the order of `directions`, one "map" chunk and as many "tile" chunks as it takes:
//   chunk (24 bytes)   kind, 4 characters | items u32 | spans u32 | payload's length u64 | CRC-32 of the 20 bytes
//   before
//                      and the payload u32 | payload
//
// A map chunk's items are the grid's tiles: a column u32 that says which stored tile stands there, 0 for the empty one,
// 1, 2, … in order of first appearance. A tile chunk's items are the next stored tiles: columns of spans per ray (u32,
// 1024 a tile), near ends, far ends (bits of a double, u64), and for "xyz" u and v of the near and the far normal
// (u16). Columns are as planes.hpp has them. Tiles of equal content are stored once, whatever their history was: equal
// volumes are equal files.
#include "dexel/file.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <unordered_map>

#include "dexel/planes.hpp"
#include "geom/error.hpp"
#include "geom/io.hpp"
#include "geom/parallel.hpp"

namespace riffler {

static_assert(std::endian::native == std::endian::little, "the file's numbers are copied as they stand in memory");

namespace {

using TilePtr = std::shared_ptr<const Tile>;
using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'R', 'V', 'O', 'L', '\r', '\n', 0x1A};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeader = 96, kChunkHeader = 24;
/// A tile chunk ends when it has this many tiles or spans: enough for deflate, small enough for every thread.
constexpr std::size_t kChunkTiles = 64, kChunkSpans = std::size_t{1} << 18;
constexpr std::uint32_t kMap = 0x2070616D, kTiles = 0x656C6974;  // "map ", "tile"

std::uint32_t checksum(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b = {}) {
  uLong crc = 0;
  for (const auto part : {a, b})
    if (!part.empty()) crc = crc32_z(crc, part.data(), part.size());  // a null pointer would start anew
  return static_cast<std::uint32_t>(crc);
}

template <class T>
void put(Bytes& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::size_t at = out.size();
  out.resize(at + sizeof value);
  std::memcpy(out.data() + at, &value, sizeof value);
}

template <class T>
T get(std::span<const std::uint8_t> bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// ---- writing

/// A grid's tiles without repetition: places[t] is 0 for an empty tile, else 1 + its index in `stored`.
struct StoredTiles {
  std::vector<std::uint32_t> places;
  std::vector<TilePtr> stored;
};

std::uint64_t content_hash(const Tile& tile) {
  const auto bytes = [](const auto& items) {
    return std::span(reinterpret_cast<const std::uint8_t*>(items.data()), items.size() * sizeof items[0]);
  };
  return (std::uint64_t{checksum(bytes(tile.offset))} << 32) + checksum(bytes(tile.spans), bytes(tile.normals));
}

bool same_content(const Tile& a, const Tile& b) {
  // Bits, not values: −0 and 0 are two different files.
  return a.offset == b.offset && a.spans.size() == b.spans.size() && a.normals == b.normals &&
         (a.spans.empty() || std::memcmp(a.spans.data(), b.spans.data(), a.spans.size() * sizeof(Span)) == 0);
}

StoredTiles without_repetition(const Grid& grid) {
  std::unordered_map<const Tile*, std::uint32_t> known;  // by address: index in `distinct`
  std::vector<TilePtr> distinct;
  std::vector<std::uint32_t> at(grid.tile_count());
  for (std::size_t t = 0; t < at.size(); ++t) {
    const auto [found, added] = known.try_emplace(&grid.tile(t), static_cast<std::uint32_t>(distinct.size()));
    if (added) distinct.push_back(grid.shared_tile(t));
    at[t] = found->second;
  }
  std::vector<std::uint64_t> hashes(distinct.size());
  parallel_for(distinct.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) hashes[k] = content_hash(*distinct[k]);
  });

  StoredTiles result;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> by_hash;
  std::vector<std::uint32_t> place(distinct.size());
  for (std::size_t k = 0; k < distinct.size(); ++k) {
    if (distinct[k]->spans.empty()) continue;
    for (const std::uint32_t p : by_hash[hashes[k]])
      if (same_content(*result.stored[p - 1], *distinct[k])) place[k] = p;
    if (place[k] != 0) continue;
    result.stored.push_back(distinct[k]);
    place[k] = static_cast<std::uint32_t>(result.stored.size());
    by_hash[hashes[k]].push_back(place[k]);
  }
  result.places.reserve(at.size());
  for (const std::uint32_t k : at) result.places.push_back(place[k]);
  return result;
}

/// What one chunk will hold: the map of a grid, or stored tiles begin … end − 1 of it.
struct Plan {
  std::size_t grid;
  std::uint32_t kind;
  std::size_t begin = 0, end = 0, spans = 0;
};

std::vector<Plan> plan_chunks(const std::vector<StoredTiles>& grids) {
  std::vector<Plan> plans;
  for (std::size_t g = 0; g < grids.size(); ++g) {
    plans.push_back({g, kMap, 0, grids[g].places.size(), 0});
    const std::vector<TilePtr>& stored = grids[g].stored;
    for (std::size_t k = 0; k < stored.size();) {
      Plan plan{g, kTiles, k, k, 0};
      while (k < stored.size() && k - plan.begin < kChunkTiles && plan.spans < kChunkSpans)
        plan.spans += stored[k++]->spans.size();
      plan.end = k;
      plans.push_back(plan);
    }
  }
  return plans;
}

void write_tiles(PlaneWriter& out, std::span<const TilePtr> tiles, std::size_t spans, bool with_normals) {
  std::vector<std::uint32_t> counts;
  counts.reserve(tiles.size() * kTileRays);
  for (const TilePtr& tile : tiles)
    for (int r = 0; r < kTileRays; ++r) counts.push_back(tile->offset[r + 1] - tile->offset[r]);
  out.column(counts);

  std::vector<std::uint64_t> ends;
  ends.reserve(spans);
  for (double Span::* end : {&Span::near, &Span::far}) {
    ends.clear();
    for (const TilePtr& tile : tiles)
      for (const Span& span : tile->spans) ends.push_back(std::bit_cast<std::uint64_t>(span.*end));
    out.column(ends);
  }
  if (!with_normals) return;

  std::vector<std::uint16_t> components;
  components.reserve(spans);
  for (PackedNormal SpanNormals::* end : {&SpanNormals::near, &SpanNormals::far})
    for (std::int16_t PackedNormal::* component : {&PackedNormal::u, &PackedNormal::v}) {
      components.clear();
      for (const TilePtr& tile : tiles)
        for (const SpanNormals& n : tile->normals) components.push_back(static_cast<std::uint16_t>(n.*end.*component));
      out.column(components);
    }
}

Bytes write_chunk(const Plan& plan, const StoredTiles& tiles, bool with_normals) {
  Bytes chunk;
  put(chunk, plan.kind);
  put(chunk, static_cast<std::uint32_t>(plan.end - plan.begin));
  put(chunk, static_cast<std::uint32_t>(plan.spans));
  chunk.resize(kChunkHeader);
  PlaneWriter out(chunk);
  if (plan.kind == kMap)
    out.column(tiles.places);
  else
    write_tiles(out, std::span(tiles.stored).subspan(plan.begin, plan.end - plan.begin), plan.spans, with_normals);
  const std::uint64_t length = chunk.size() - kChunkHeader;
  std::memcpy(chunk.data() + 12, &length, sizeof length);
  const std::span whole(chunk);
  const std::uint32_t crc = checksum(whole.first(20), whole.subspan(kChunkHeader));
  std::memcpy(chunk.data() + 20, &crc, sizeof crc);
  return chunk;
}

Bytes write_header(const Frame& frame, std::uint64_t length, std::uint64_t spans, std::uint32_t tiles) {
  Bytes header;
  put(header, kMagic);
  put(header, kVersion);
  std::array<char, 4> directions{};
  std::copy(frame.directions.begin(), frame.directions.end(), directions.begin());
  put(header, directions);
  put(header, length);
  for (const Vec3& corner : {frame.box.lower, frame.box.upper})
    for (int k = 0; k < 3; ++k) put(header, corner[k]);
  put(header, frame.pitch);
  put(header, spans);
  put(header, tiles);
  put(header, checksum(header));
  return header;
}

// ---- reading

struct Header {
  Frame frame;
  std::uint64_t spans;
  std::uint32_t tiles;
};

/// One chunk as its header describes it; `payload` begins at byte `at` + kChunkHeader of the file.
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
    fail(0, "not a .rvol file (its first eight bytes are others)");
  if (bytes_.size() < kHeader) fail(bytes_.size(), "the file ends within its header");
  const auto version = get<std::uint32_t>(bytes_, 8);
  if (version != kVersion)
    fail(8, "version " + std::to_string(version) + "; this program reads version " + std::to_string(kVersion));
  if (get<std::uint32_t>(bytes_, kHeader - 4) != checksum(bytes_.first(kHeader - 4)))
    fail(kHeader - 4, "the header's checksum does not fit");
  const auto length = get<std::uint64_t>(bytes_, 16);
  if (bytes_.size() < length)
    fail(bytes_.size(), "the file ends here, but should have " + std::to_string(length) + " bytes");
  if (bytes_.size() > length) fail(length, "there is more after the file's end");

  Header header;
  const auto directions = get<std::array<char, 4>>(bytes_, 12);
  header.frame.directions.assign(directions.begin(), std::find(directions.begin(), directions.end(), '\0'));
  for (int k = 0; k < 3; ++k) {
    header.frame.box.lower[k] = get<double>(bytes_, 24 + 8 * k);
    header.frame.box.upper[k] = get<double>(bytes_, 48 + 8 * k);
  }
  header.frame.pitch = get<double>(bytes_, 72);
  header.spans = get<std::uint64_t>(bytes_, 80);
  header.tiles = get<std::uint32_t>(bytes_, 88);
  return header;
}

/// Before anything is allocated: the tiles' map and the spans must be such as this many bytes can hold.
void Reader::check_affordable(const Header& header) const {
  const Frame& frame = header.frame;
  const double most = static_cast<double>(kMostDeflated) * static_cast<double>(bytes_.size());
  double places = 0;
  for (const Axis axis : parse_directions(frame.directions)) {
    const Vec3 size = to_local(axis, frame.box).size() / frame.pitch;
    places += std::ceil(std::max(1.0, std::round(size.x)) / kTileSide) *
              std::ceil(std::max(1.0, std::round(size.y)) / kTileSide);
  }
  // A place of the map takes four planes, a span sixteen or more, a tile's counts four of 1024 bytes.
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
  Chunk chunk{grid, get<std::uint32_t>(head, 0), get<std::uint32_t>(head, 4), get<std::uint32_t>(head, 8), at, {}};
  const auto length = get<std::uint64_t>(head, 12);
  if (length > head.size() - kChunkHeader) fail(at + 12, "the chunk is longer than the rest of the file");
  chunk.payload = head.subspan(kChunkHeader, length);
  return chunk;
}

/// Walks over the chunks' headers; their payloads are looked at later, in parallel.
std::vector<Chunk> Reader::chunks(std::size_t grids, const Header& header) const {
  std::vector<Chunk> all;
  std::size_t at = kHeader, maps = 0;
  std::uint64_t spans = 0, tiles = 0;
  while (at < bytes_.size()) {
    const auto kind = bytes_.size() - at < kChunkHeader ? 0 : get<std::uint32_t>(bytes_, at);
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
                 " tiles, the chunks " + std::to_string(spans) + " in " + std::to_string(tiles));
  return all;
}

std::vector<std::uint32_t> Reader::map(const Chunk& chunk, const Grid& grid) const {
  if (chunk.items != grid.tile_count() || chunk.spans != 0)
    fail(chunk.at + 4, "the map has " + std::to_string(chunk.items) + " places, the grid " +
                           std::to_string(grid.tile_count()) + " tiles");
  PlaneReader in(chunk.payload, chunk.at + kChunkHeader, name_);
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
  PlaneReader in(chunk.payload, chunk.at + kChunkHeader, name_);
  const std::vector<std::uint32_t> counts = in.column32(std::size_t{chunk.items} * kTileRays);
  std::uint64_t sum = 0;
  for (const std::uint32_t count : counts) sum += count;
  if (sum != chunk.spans) fail(chunk.at + 8, "the rays' spans are not as many as the chunk's");
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
        fail(chunk.at, "a span of the chunk is turned round, empty or outside the box");
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

/// Puts the tile there unless it has material on rays that lie beyond the grid.
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
  parallel_for(
      all.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const Chunk& chunk = all[k];
          if (get<std::uint32_t>(bytes_, chunk.at + 20) != checksum(bytes_.subspan(chunk.at, 20), chunk.payload))
            fail(chunk.at, "the chunk's checksum does not fit");
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
      fail(kHeader, "the map uses " + std::to_string(used) + " tiles, stored are " + std::to_string(stored[g].size()));
    for (std::size_t t = 0; t < maps[g].size(); ++t)
      if (maps[g][t] > 0) place(grids[g], t, stored[g][maps[g][t] - 1]);
  }
  return volume;
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const Volume& volume, const Progress& progress) {
  std::vector<StoredTiles> tiles;
  for (const Grid& grid : volume.grids()) tiles.push_back(without_repetition(grid));
  const std::vector<Plan> plans = plan_chunks(tiles);
  std::vector<Bytes> chunks(plans.size());
  parallel_for(
      plans.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          chunks[k] = write_chunk(plans[k], tiles[plans[k].grid], volume.grids()[plans[k].grid].has_normals());
      },
      progress);

  std::uint64_t length = kHeader, spans = 0;
  std::uint32_t stored = 0;
  for (const Bytes& chunk : chunks) length += chunk.size();
  for (const Plan& plan : plans) spans += plan.spans;
  for (const StoredTiles& grid : tiles) stored += static_cast<std::uint32_t>(grid.stored.size());
  Bytes bytes = write_header(volume.frame(), length, spans, stored);
  bytes.reserve(length);
  for (Bytes& chunk : chunks) {
    bytes.insert(bytes.end(), chunk.begin(), chunk.end());
    Bytes().swap(chunk);
  }
  return bytes;
}

Volume from_bytes(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress) {
  return Reader(bytes, name).run(progress);
}

void save(const Volume& volume, const std::filesystem::path& path, const Progress& progress) {
  write_file(path, to_bytes(volume, progress));
}

Volume load(const std::filesystem::path& path, const Progress& progress) {
  return from_bytes(read_file(path), path.filename().string(), progress);
}

}  // namespace riffler
