// Writes .rvol files.
#include <algorithm>
#include <unordered_map>

#include "base/io.hpp"
#include "base/planes.hpp"
#include "dexel/file/format.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/dexel/file/file.hpp"

namespace riffler::dexel {

namespace {

using namespace rvol;
using TilePtr = std::shared_ptr<const Tile>;

/// A grid's distinct tiles: places[t] is 0 for an empty tile, otherwise 1 + its index in `stored`.
struct StoredTiles {
  std::vector<std::uint32_t> places;
  std::vector<TilePtr> stored;
};

std::uint64_t content_hash(const Tile& tile) {
  const auto bytes = [](const auto& items) {
    return std::span(reinterpret_cast<const std::uint8_t*>(items.data()), items.size() * sizeof items[0]);
  };
  return (std::uint64_t{base::checksum(bytes(tile.offset))} << 32) +
         base::checksum(bytes(tile.spans), bytes(tile.normals));
}

bool same_content(const Tile& a, const Tile& b) {
  // Compares bits, not values: −0 and 0 are different in a file.
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
  base::parallel_for(distinct.size(), 64, [&](std::size_t begin, std::size_t end) {
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

/// Content of one chunk: the map of a grid, or its stored tiles begin … end − 1.
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

void write_tiles(base::PlaneWriter& out, std::span<const TilePtr> tiles, std::size_t spans, bool with_normals) {
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
  base::put(chunk, plan.kind);
  base::put(chunk, static_cast<std::uint32_t>(plan.end - plan.begin));
  base::put(chunk, static_cast<std::uint32_t>(plan.spans));
  chunk.resize(kChunkHeader);
  base::PlaneWriter out(chunk);
  if (plan.kind == kMap)
    out.column(tiles.places);
  else
    write_tiles(out, std::span(tiles.stored).subspan(plan.begin, plan.end - plan.begin), plan.spans, with_normals);
  const std::uint64_t length = chunk.size() - kChunkHeader;
  std::memcpy(chunk.data() + 12, &length, sizeof length);
  const std::span whole(chunk);
  const std::uint32_t crc = base::checksum(whole.first(20), whole.subspan(kChunkHeader));
  std::memcpy(chunk.data() + 20, &crc, sizeof crc);
  return chunk;
}

Bytes write_header(const Frame& frame, std::uint64_t length, std::uint64_t spans, std::uint32_t tiles) {
  Bytes header;
  base::put(header, kMagic);
  base::put(header, kVersion);
  std::array<char, 4> directions{};
  std::copy(frame.directions.begin(), frame.directions.end(), directions.begin());
  base::put(header, directions);
  base::put(header, length);
  for (const Vec3& corner : {frame.box.lower, frame.box.upper})
    for (int k = 0; k < 3; ++k) base::put(header, corner[k]);
  base::put(header, frame.pitch);
  base::put(header, spans);
  base::put(header, tiles);
  base::put(header, base::checksum(header));
  return header;
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const Volume& volume, const Progress& progress) {
  std::vector<StoredTiles> tiles;
  for (const Grid& grid : volume.grids()) tiles.push_back(without_repetition(grid));
  const std::vector<Plan> plans = plan_chunks(tiles);
  std::vector<Bytes> chunks(plans.size());
  base::parallel_for(
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

void save(const Volume& volume, const std::filesystem::path& path, const Progress& progress) {
  base::write_file(path, to_bytes(volume, progress));
}

}  // namespace riffler::dexel
