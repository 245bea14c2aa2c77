#include "marching/neighbourhood.hpp"

namespace riffler::marching {

Neighbourhood::Neighbourhood(const Bricks& bricks, const Vec3i& brick) {
  // Two bits of the brick below, all of the middle one, two of the one above.
  std::uint64_t* out = words_.data();
  for (int i = -kLayers; i < kBrickSide + kLayers; ++i) {
    const int a = brick.x + (i >> 5), row = (i & 31) * kBrickSide;
    for (int b = -1; b <= 1; ++b) {
      const std::uint32_t *const below = bricks.signs(a, brick.y + b, brick.z - 1).data() + row,
                                 *const here = bricks.signs(a, brick.y + b, brick.z).data() + row,
                                 *const above = bricks.signs(a, brick.y + b, brick.z + 1).data() + row;
      const int from = b < 0 ? kBrickSide - kLayers : 0, to = b > 0 ? kLayers : kBrickSide;
      for (int j = from; j < to; ++j)
        *out++ = below[j] >> (kBrickSide - kLayers) | std::uint64_t{here[j]} << kLayers |
                 std::uint64_t{above[j] & ((1U << kLayers) - 1)} << (kBrickSide + kLayers);
    }
  }
}

}  // namespace riffler::marching
