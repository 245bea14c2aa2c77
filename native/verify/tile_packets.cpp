#include "verify/tile_packets.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

namespace riffler::verify {

namespace {

enum State : std::uint8_t { Null, Empty, Spans, Normals };

State state_of(const std::shared_ptr<const dexel::Tile>& tile) {
  if (!tile) return Null;
  return tile->spans.empty() ? Empty : tile->normals.empty() ? Spans : Normals;
}

using Components = std::array<std::vector<std::uint16_t>, 4>;

std::array<std::uint16_t, 4> components_of(const dexel::SpanNormals& n) {
  return {static_cast<std::uint16_t>(n.near.u), static_cast<std::uint16_t>(n.near.v),
          static_cast<std::uint16_t>(n.far.u), static_cast<std::uint16_t>(n.far.v)};
}

dexel::SpanNormals normals_at(const Components& components, std::size_t k) {
  const auto at = [&](std::size_t which) { return static_cast<std::int16_t>(components[which][k]); };
  return {{at(0), at(1)}, {at(2), at(3)}};
}

/// Columns of all tiles together: a single tile is too short to compress.
struct Columns {
  std::vector<std::uint32_t> counts;
  std::vector<std::uint64_t> near, far;
  Components normals;
};

std::shared_ptr<dexel::Tile> tile_of(PacketReader& in, const Columns& columns, std::size_t tile, State state,
                                     std::size_t& span, std::size_t& normal) {
  dexel::TileBuilder builder(state == Normals);
  for (std::size_t r = 0; r < dexel::kTileRays; ++r) {
    for (std::uint32_t k = 0; k < columns.counts[tile * dexel::kTileRays + r]; ++k, ++span) {
      if (span >= columns.near.size()) in.fail("fewer spans than its rays have");
      const dexel::Span s{std::bit_cast<double>(columns.near[span]), std::bit_cast<double>(columns.far[span])};
      const bool follows = k == 0 || std::bit_cast<double>(columns.far[span - 1]) < s.near;
      if (!(s.near < s.far) || !follows || !std::isfinite(s.near) || !std::isfinite(s.far))
        in.fail("spans that are not in order");
      builder.add(s, state == Normals ? normals_at(columns.normals, normal++) : dexel::SpanNormals{});
    }
    builder.next_ray();
  }
  return builder.finish();
}

}  // namespace

void put_tiles(PacketWriter& out, const SlabTiles& tiles) {
  std::vector<std::uint8_t> states;
  std::vector<double> reach;
  Columns columns;
  for (const auto& tile : tiles) {
    states.push_back(state_of(tile));
    if (states.back() < Spans) continue;
    reach.push_back(tile->reach.near), reach.push_back(tile->reach.far);
    for (int r = 0; r < dexel::kTileRays; ++r) columns.counts.push_back(tile->offset[r + 1] - tile->offset[r]);
    for (const dexel::Span& s : tile->spans) {
      columns.near.push_back(std::bit_cast<std::uint64_t>(s.near));
      columns.far.push_back(std::bit_cast<std::uint64_t>(s.far));
    }
    for (const dexel::SpanNormals& n : tile->normals) {
      const std::array<std::uint16_t, 4> four = components_of(n);
      for (std::size_t c = 0; c < four.size(); ++c) columns.normals[c].push_back(four[c]);
    }
  }
  out.put_all(std::span<const std::uint8_t>(states));
  out.put_all(std::span<const double>(reach));
  out.put(static_cast<std::uint64_t>(columns.near.size()));
  out.put(static_cast<std::uint64_t>(columns.normals[0].size()));
  out.columns([&](base::PlaneWriter& planes) {
    planes.column(columns.counts), planes.column(columns.near), planes.column(columns.far);
    for (const auto& component : columns.normals) planes.column(component);
  });
}

SlabTiles get_tiles(PacketReader& in) {
  const std::vector<std::uint8_t> states = in.get_all<std::uint8_t>();
  const std::vector<double> reach = in.get_all<double>();
  const auto full = static_cast<std::size_t>(std::ranges::count_if(states, [](auto s) { return s >= Spans; }));
  if (reach.size() != 2 * full || std::ranges::any_of(states, [](auto s) { return s > Normals; }))
    in.fail("invalid tiles");
  const std::size_t spans = in.count(), normals = in.count();
  Columns columns;
  in.columns([&](base::PlaneReader& planes) {
    columns.counts = planes.column32(full * dexel::kTileRays);
    columns.near = planes.column64(spans), columns.far = planes.column64(spans);
    for (auto& component : columns.normals) component = planes.column16(normals);
  });
  SlabTiles tiles(states.size());
  std::size_t k = 0, span = 0, normal = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    if (states[t] == Null) continue;
    if (states[t] == Empty) {
      tiles[t] = base::make_shared_block<const dexel::Tile>();
      continue;
    }
    if (states[t] == Normals) {
      const auto* first = columns.counts.data() + k * dexel::kTileRays;
      if (std::accumulate(first, first + dexel::kTileRays, normal) > normals) in.fail("fewer normals than spans");
    }
    const std::shared_ptr<dexel::Tile> tile = tile_of(in, columns, k, static_cast<State>(states[t]), span, normal);
    tile->reach = {reach[2 * k], reach[2 * k + 1]};
    tiles[t] = tile, ++k;
  }
  if (span != spans || normal != normals) in.fail("more spans than its rays have");
  return tiles;
}

}  // namespace riffler::verify
