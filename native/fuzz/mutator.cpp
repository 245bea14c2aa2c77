#include "fuzz/mutator.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace riffler::fuzz {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::string_view kWords[] = {"nan",
                                       "-inf",
                                       "1e999",
                                       "-1",
                                       "0",
                                       "4294967295",
                                       "18446744073709551615",
                                       "99999999",
                                       "1e-300",
                                       "1e30",
                                       ".",
                                       "-",
                                       "\n",
                                       "\r\n",
                                       "\\",
                                       "/",
                                       " ",
                                       "\t",
                                       "solid ",
                                       "endsolid",
                                       "facet normal 0 0 0\n",
                                       "outer loop\n",
                                       "vertex 0 0 0\n",
                                       "element vertex 3\n",
                                       "element face 1\n",
                                       "property list uchar int vertex_indices\n",
                                       "property double x\n",
                                       "end_header\n",
                                       "format ascii 1.0\n",
                                       "v 0 0 0\n",
                                       "f 1 2 3\n",
                                       "f -1 -2 -3\n",
                                       "G0 ",
                                       "G1 ",
                                       "G2 ",
                                       "G3 ",
                                       "G5 ",
                                       "G17",
                                       "G18",
                                       "G20",
                                       "G43.4 H1",
                                       "G81 R1 Z-1 L",
                                       "G83 R1 Z-1 Q",
                                       "G91",
                                       "G92",
                                       "G93",
                                       "M98 P1 L",
                                       "M99",
                                       "M70",
                                       "M72",
                                       "X",
                                       "Y",
                                       "Z",
                                       "A",
                                       "B",
                                       "C",
                                       "I",
                                       "J",
                                       "K",
                                       "R",
                                       "F",
                                       "S",
                                       "T",
                                       "L",
                                       "P",
                                       "Q",
                                       "#1=",
                                       "#<a>=",
                                       "[",
                                       "]",
                                       "o1 sub\n",
                                       "o1 endsub\n",
                                       "o1 call\n",
                                       "o1 repeat [9]\n",
                                       "o1 endrepeat\n",
                                       "o1 while [1]\n",
                                       "o1 endwhile\n",
                                       "o1 if [0]\n",
                                       "o1 endif\n",
                                       "o1 do\n",
                                       "(",
                                       ")",
                                       ";",
                                       "%\n",
                                       "GOTO/",
                                       "CIRCLE/",
                                       "CYCLE/DRILL,FEDTO,1",
                                       "$\n",
                                       "$$",
                                       "FEDRAT/",
                                       "UNITS/INCHES",
                                       "MULTAX/ON",
                                       "= ",
                                       "[[",
                                       "]]",
                                       "\"",
                                       "'''",
                                       "true",
                                       "[options]\n",
                                       "[axis.x]\n",
                                       ", ",
                                       "#"};

}  // namespace

void Mutator::mutate(Bytes& bytes, std::span<const std::uint8_t> other, std::size_t most) {
  for (std::size_t n = 1 + (below(2) == 0 ? below(8) : below(2)); n > 0; --n) change(bytes, other);
  if (bytes.size() > most) bytes.resize(most);
}

void Mutator::change(Bytes& bytes, std::span<const std::uint8_t> other) {
  const std::size_t at = below(bytes.size() + 1),
                    length = std::min(bytes.size() - at, 1 + below(below(4) == 0 ? 256 : 8));
  const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  const auto insert = [&](auto first, auto last) { bytes.insert(begin, first, last); };
  switch (below(14)) {
    case 0:
      if (at < bytes.size()) bytes[at] = static_cast<std::uint8_t>(random_());
      break;
    case 1:
      if (at < bytes.size()) bytes[at] ^= static_cast<std::uint8_t>(1U << below(8));
      break;
    case 2:
      bytes.erase(begin, begin + static_cast<std::ptrdiff_t>(length));
      break;
    case 3: {  // repeat a piece
      const Bytes piece(begin, begin + static_cast<std::ptrdiff_t>(length));
      const std::size_t times = below(8) == 0 ? 1 + below(64) : 1;
      for (std::size_t k = 0; k < times; ++k)
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), piece.begin(), piece.end());
      break;
    }
    case 4: {  // insert a piece of another input
      const std::size_t from = below(other.size() + 1), size = std::min(other.size() - from, 1 + below(256));
      insert(other.begin() + static_cast<std::ptrdiff_t>(from),
             other.begin() + static_cast<std::ptrdiff_t>(from + size));
      break;
    }
    case 5:
      bytes.resize(at);
      break;
    case 6: {  // a number near an end of its range
      static constexpr std::uint64_t kEdges[] = {0,
                                                 1,
                                                 0x7F,
                                                 0x80,
                                                 0xFF,
                                                 0x7FFF,
                                                 0xFFFF,
                                                 0x7FFFFFFF,
                                                 0x80000000,
                                                 0xFFFFFFFF,
                                                 0x7FF0000000000000,
                                                 0x7FFFFFFFFFFFFFFF,
                                                 0xFFFFFFFFFFFFFFFF};
      const std::uint64_t value = kEdges[below(std::size(kEdges))] + below(3) - 1;
      const std::size_t size = std::min(bytes.size() - at, std::size_t{1} << below(4));
      for (std::size_t k = 0; k < size; ++k) bytes[at + k] = static_cast<std::uint8_t>(value >> (8 * k));
      break;
    }
    case 7:  // another digit: most results are still valid
    case 8: {
      for (std::size_t k = at; k < std::min(bytes.size(), at + 64); ++k)
        if (bytes[k] >= '0' && bytes[k] <= '9') {
          bytes[k] = static_cast<std::uint8_t>('0' + below(10));
          break;
        }
      break;
    }
    case 9:
      std::fill(begin, begin + static_cast<std::ptrdiff_t>(length),
                below(2) == 0 ? std::uint8_t{0} : std::uint8_t{0xFF});
      break;
    case 10:  // swap two pieces
      if (length > 1)
        std::rotate(begin, begin + static_cast<std::ptrdiff_t>(length / 2),
                    begin + static_cast<std::ptrdiff_t>(length));
      break;
    default: {
      const std::string_view word = kWords[below(std::size(kWords))];
      if (below(2) == 0) bytes.erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(length, word.size())));
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), word.begin(), word.end());
    }
  }
}

}  // namespace riffler::fuzz
