#include "nurbs/trimmed_net.hpp"

#include <algorithm>
#include <array>

#include "nurbs/binomials.hpp"

namespace riffler::nurbs {

namespace {

/// Arguments of a blossom: so many times each value.
struct Arguments {
  std::array<double, 4> value;
  std::array<int, 4> times;
};

/// The symmetric multi-affine function of a Bézier curve of `degree`, by de Casteljau's algorithm with one argument for
/// each step. Arguments in [0, 1] make convex combinations only.
Vec4 blossom(const Vec4* points, std::size_t step, int degree, const Arguments& arguments) {
  std::array<Vec4, kMaxOrder> d;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i) d[i] = points[i * step];
  int left = degree;
  for (std::size_t k = 0; k < 4; ++k)
    for (int n = 0; n < arguments.times[k]; ++n, --left)
      for (std::size_t i = 0; i < static_cast<std::size_t>(left); ++i)
        d[i] = (1 - arguments.value[k]) * d[i] + arguments.value[k] * d[i + 1];
  return d[0];
}

bool is_rectangle(const Trapezoid& piece) {
  return piece.left[0] == piece.left[1] && piece.right[0] == piece.right[1];
}

}  // namespace

Degrees degrees_over(const Degrees& degrees, const Trapezoid& piece) {
  return {degrees.u, is_rectangle(piece) ? degrees.v : degrees.u + degrees.v};
}

void trimmed_net(const Vec4* net, const Degrees& degrees, const Trapezoid& piece, Vec4* out) {
  const int p = degrees.u, q = degrees.v;
  std::array<Vec4, kMaxNet> band;  // between the lines of constant v
  for (int i = 0; i <= p; ++i)
    for (int j = 0; j <= q; ++j)
      band[degrees.at(i, j)] = blossom(net + degrees.at(i, 0), 1, q, {{piece.low, piece.high, 0, 0}, {q - j, j, 0, 0}});
  const Degrees made = degrees_over(degrees, piece);
  std::fill(out, out + made.size(), Vec4(0));
  // The blossom in u with arguments that are linear in t is a polynomial in t: its coefficients have each argument at
  // one of the two ends.
  const int over_t = is_rectangle(piece) ? 0 : p;
  for (int j = 0; j <= q; ++j)
    for (int k = 0; k <= p; ++k)
      for (int a = 0; a <= std::min(over_t, p - k); ++a)
        for (int b = 0; b <= std::min(over_t, k); ++b) {
          const Arguments arguments{{piece.left[0], piece.left[1], piece.right[0], piece.right[1]},
                                    {p - k - a, a, k - b, b}};
          const double share =
              over_t == 0 ? 1
                          : kBinomials(p - k, a) * kBinomials(k, b) * kBinomials(q, j) / kBinomials(p + q, a + b + j);
          out[made.at(k, a + b + j)] += share * blossom(band.data() + j, degrees.at(1, 0), p, arguments);
        }
}

void border_net(const Vec4* net, const Degrees& degrees, const Vec2& a, const Vec2& b, Vec4* out) {
  const int p = degrees.u, q = degrees.v;
  std::fill(out, out + p + q + 1, Vec4(0));
  std::array<Vec4, kMaxOrder> column;
  for (int j = 0; j <= q; ++j) {
    for (int i = 0; i <= p; ++i)
      column[static_cast<std::size_t>(i)] = blossom(net + degrees.at(i, 0), 1, q, {{a.y, b.y, 0, 0}, {q - j, j, 0, 0}});
    for (int i = 0; i <= p; ++i)
      out[i + j] += kBinomials(p, i) * kBinomials(q, j) / kBinomials(p + q, i + j) *
                    blossom(column.data(), 1, p, {{a.x, b.x, 0, 0}, {p - i, i, 0, 0}});
  }
}

Vec2 side_lengths(const Vec4* net, const Degrees& degrees) {
  Vec2 most(0);
  for (int i = 0; i <= degrees.u; ++i) {
    double length = 0;
    for (int j = 0; j < degrees.v; ++j)
      length += glm::length(affine(net[degrees.at(i, j + 1)]) - affine(net[degrees.at(i, j)]));
    most.y = std::max(most.y, length);
  }
  for (int j = 0; j <= degrees.v; ++j) {
    double length = 0;
    for (int i = 0; i < degrees.u; ++i)
      length += glm::length(affine(net[degrees.at(i + 1, j)]) - affine(net[degrees.at(i, j)]));
    most.x = std::max(most.x, length);
  }
  return most;
}

}  // namespace riffler::nurbs
