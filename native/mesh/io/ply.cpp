#include "mesh/io/ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "geom/float32.hpp"
#include "mesh/io/scan.hpp"
#include "mesh/weld.hpp"
#include "riffler/base/error.hpp"

namespace riffler::mesh {

namespace {

static_assert(std::endian::native == std::endian::little, "written and read as on a little-endian machine");

struct Type {
  std::string_view name, other_name;
  unsigned size;
  enum Kind { Signed, Unsigned, Real } kind;
};

constexpr Type kTypes[] = {{"char", "int8", 1, Type::Signed},   {"uchar", "uint8", 1, Type::Unsigned},
                           {"short", "int16", 2, Type::Signed}, {"ushort", "uint16", 2, Type::Unsigned},
                           {"int", "int32", 4, Type::Signed},   {"uint", "uint32", 4, Type::Unsigned},
                           {"float", "float32", 4, Type::Real}, {"double", "float64", 8, Type::Real}};

struct Property {
  std::string name;
  const Type* type = nullptr;
  const Type* count = nullptr;  // count type of a list; null for a single value
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;

  /// Minimum size of a row in bytes: with empty lists.
  std::size_t least() const {
    std::size_t size = 0;
    for (const Property& p : properties) size += p.count ? p.count->size : p.type->size;
    return size;
  }
};

enum class Coding { Ascii, Little, Big };

struct Header {
  Coding coding = Coding::Ascii;
  std::vector<Element> elements;
  std::size_t lines = 0, size = 0;
};

class HeaderReader {
 public:
  HeaderReader(std::span<const std::uint8_t> bytes, const std::string& name) : scan_(bytes, name) {}

  Header read() {
    if (scan_.token_in_line() != "ply") scan_.fail("expected 'ply' at the start of the file");
    end_line();
    for (;; end_line()) {
      const std::string_view word = scan_.token_in_line();
      if (word == "comment" || word == "obj_info") {
        while (!scan_.token_in_line().empty()) {
        }
      } else if (word == "format") {
        format();
      } else if (word == "element") {
        element();
      } else if (word == "property") {
        property();
      } else if (word == "end_header") {
        break;
      } else if (!word.empty() || scan_.at_end()) {
        scan_.fail_expected("a line of the header or 'end_header'", word);
      }
    }
    if (!has_format_) scan_.fail("the header has no line 'format'");
    end_line();
    header_.lines = scan_.line(), header_.size = scan_.offset();
    return std::move(header_);
  }

 private:
  void end_line() {
    if (const std::string_view rest = scan_.token_in_line(); !rest.empty())
      scan_.fail_expected("the end of the line", rest);
    scan_.next_line();
  }

  void format() {
    const std::string_view coding = scan_.token_in_line();
    if (coding == "ascii")
      header_.coding = Coding::Ascii;
    else if (coding == "binary_little_endian")
      header_.coding = Coding::Little;
    else if (coding == "binary_big_endian")
      header_.coding = Coding::Big;
    else
      scan_.fail_expected("'ascii', 'binary_little_endian' or 'binary_big_endian'", coding);
    if (const std::string_view version = scan_.token_in_line(); version != "1.0")
      scan_.fail_expected("version '1.0'", version);
    has_format_ = true;
  }

  void element() {
    Element element;
    element.name = scan_.token_in_line();
    // Files have two or three elements; the search below is linear, and this many are still fast.
    constexpr std::size_t kMaxElements = 1000;
    if (header_.elements.size() == kMaxElements) scan_.fail("more than 1000 elements");
    for (const Element& other : header_.elements)
      if (other.name == element.name) scan_.fail("element " + in_quotes(element.name) + " twice");
    const std::string_view word = scan_.token_in_line();
    const std::optional<std::int64_t> count = to_integer(word);
    if (!count || *count < 0) scan_.fail_expected("a count", word);
    element.count = static_cast<std::size_t>(*count);
    header_.elements.push_back(std::move(element));
  }

  void property() {
    if (header_.elements.empty()) scan_.fail("a property before the first element");
    Property property;
    std::string_view word = scan_.token_in_line();
    if (word == "list") {
      property.count = type(scan_.token_in_line());
      if (property.count->kind == Type::Real) scan_.fail("a list's count must be an integer");
      word = scan_.token_in_line();
    }
    property.type = type(word);
    property.name = scan_.token_in_line();
    if (property.name.empty()) scan_.fail_expected("a property's name", "");
    header_.elements.back().properties.push_back(std::move(property));
  }

  const Type* type(std::string_view word) {
    for (const Type& type : kTypes)
      if (word == type.name || word == type.other_name) return &type;
    scan_.fail_expected("a type", word);
  }

  Scanner scan_;
  Header header_;
  bool has_format_ = false;
};

/// Values after an ASCII header.
class TextValues {
 public:
  TextValues(std::span<const std::uint8_t> bytes, const Header& header, const std::string& name)
      : scan_(bytes.subspan(header.size), name, header.lines) {}

  double real(const Type&) { return scan_.number("a finite number"); }
  std::int64_t integer(const Type&) {
    const std::string_view word = scan_.token();
    const std::optional<std::int64_t> value = to_integer(word);
    if (!value) scan_.fail_expected("an integer", word);
    return *value;
  }
  void skip(const Type&) { scan_.skip_number("a number"); }
  /// Throws if the file cannot hold this many rows.
  void check_rows(const Element&) const {}
  void check_end() {
    if (const std::string_view word = scan_.token(); !word.empty()) scan_.fail_expected("the end of the file", word);
  }
  std::size_t left() const { return static_cast<std::size_t>(-1); }
  [[noreturn]] void fail(const std::string& what) const { scan_.fail(what); }

 private:
  Scanner scan_;
};

/// Values after a binary header.
template <bool kSwap>
class BinaryValues {
 public:
  BinaryValues(std::span<const std::uint8_t> bytes, const Header& header, const std::string& name)
      : bytes_(bytes), at_(header.size), name_(name) {}

  double real(const Type& type) {
    const std::uint64_t bits = take(type.size);
    if (type.kind == Type::Real)
      return type.size == 4 ? std::bit_cast<float>(static_cast<std::uint32_t>(bits)) : std::bit_cast<double>(bits);
    return static_cast<double>(extend(type, bits));
  }
  std::int64_t integer(const Type& type) { return extend(type, take(type.size)); }
  void skip(const Type& type) { take(type.size); }
  void check_rows(const Element& element) const {
    if (element.count > 0 && (element.least() == 0 || element.count > left() / element.least()))
      fail(std::to_string(element.count) + " rows of element " + in_quotes(element.name) + " do not fit the " +
           std::to_string(left()) + " bytes left");
  }
  void check_end() const {
    if (left() > 0) fail(std::to_string(left()) + " bytes left over");
  }
  std::size_t left() const { return bytes_.size() - at_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw FormatError(name_, "byte " + std::to_string(at_), what);
  }

 private:
  std::uint64_t take(unsigned size) {
    if (left() < size) fail("the file ends within a row");
    std::array<std::uint8_t, 8> raw{};
    std::memcpy(raw.data(), &bytes_[at_], size);
    if (kSwap) std::reverse(raw.begin(), raw.begin() + size);
    at_ += size;
    return std::bit_cast<std::uint64_t>(raw);
  }
  static std::int64_t extend(const Type& type, std::uint64_t bits) {
    const unsigned shift = 64 - 8 * type.size;
    return type.kind == Type::Signed ? static_cast<std::int64_t>(bits << shift) >> shift
                                     : static_cast<std::int64_t>(bits);
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_;
  const std::string& name_;
};

template <class Values>
class BodyReader {
 public:
  BodyReader(Values values, const Progress& progress) : values_(std::move(values)), progress_(progress) {}

  Mesh read(const Header& header) {
    for (const Element& element : header.elements) {
      values_.check_rows(element);
      if (element.name == "vertex")
        vertices(element);
      else if (element.name == "face")
        faces(element);
      else
        for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i) {
          listen(i, element);
          for (const Property& property : element.properties) skip(property);
        }
    }
    values_.check_end();
    if (mesh_.triangles.empty()) values_.fail("zero faces");
    mesh_.vertices.assign(welder_.points().begin(), welder_.points().end());
    return std::move(mesh_);
  }

 private:
  void vertices(const Element& element) {
    // slot[p]: coordinate index of property p, -1 for none
    std::vector<int> slot;
    unsigned found = 0;
    for (const Property& p : element.properties) {
      const bool coordinate = !p.count && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z';
      slot.push_back(coordinate ? p.name[0] - 'x' : -1);
      if (coordinate) found |= 1U << slot.back();
    }
    if (found != 7) values_.fail("element 'vertex' has no x, y, z");
    for (std::size_t i = 0; i < element.count; ++i) {
      listen(i, element);
      Vec3 v(0);
      for (std::size_t p = 0; p < slot.size(); ++p) {
        if (slot[p] < 0)
          skip(element.properties[p]);
        else
          v[slot[p]] = coordinate(*element.properties[p].type);
      }
      welded_.push_back(welder_.add(v));
    }
  }

  double coordinate(const Type& type) {
    const double x = values_.real(type);
    if (!std::isfinite(x)) values_.fail("a vertex is not finite");
    if (!(std::abs(x) <= 1e30)) values_.fail("a vertex's coordinate is beyond 1e30");
    return x;
  }

  void faces(const Element& element) {
    const Property* indices = nullptr;
    for (const Property& p : element.properties)
      if (p.count && p.type->kind != Type::Real && (p.name == "vertex_indices" || p.name == "vertex_index"))
        indices = &p;
    if (!indices) values_.fail("element 'face' has no list of integers vertex_indices");
    std::vector<int> corners;
    for (std::size_t i = 0; i < element.count; ++i) {
      listen(i, element);
      for (const Property& p : element.properties) {
        if (&p != indices) {
          skip(p);
          continue;
        }
        const std::size_t n = length(p);
        if (n < 3) values_.fail("a face with fewer than three vertices");
        corners.clear();
        for (std::size_t k = 0; k < n; ++k) corners.push_back(corner(p));
        for (std::size_t k = 2; k < n; ++k) mesh_.triangles.emplace_back(corners[0], corners[k - 1], corners[k]);
      }
    }
  }

  /// Reports progress as the fraction of the current element.
  void listen(std::size_t row, const Element& element) const {
    constexpr std::size_t kRowsAReport = 1 << 14;
    if (row % kRowsAReport == 0) base::report(progress_, static_cast<double>(row) / static_cast<double>(element.count));
  }

  int corner(const Property& p) {
    const std::int64_t v = values_.integer(*p.type);
    if (v < 0 || v >= static_cast<std::int64_t>(welded_.size()))
      values_.fail("no vertex " + std::to_string(v) + ": there are " + std::to_string(welded_.size()) +
                   ", counted from 0");
    return welded_[static_cast<std::size_t>(v)];
  }

  std::size_t length(const Property& list) {
    const std::int64_t n = values_.integer(*list.count);
    if (n < 0 || static_cast<std::size_t>(n) > values_.left() / list.type->size)
      values_.fail("a list with " + std::to_string(n) + " values");
    return static_cast<std::size_t>(n);
  }

  void skip(const Property& property) {
    const std::size_t n = property.count ? length(property) : 1;
    for (std::size_t k = 0; k < n; ++k) values_.skip(*property.type);
  }

  Values values_;
  const Progress& progress_;
  Welder<Vec3> welder_;
  std::vector<int> welded_;  // vertex of the file → vertex of the mesh
  Mesh mesh_;
};

bool exact_in_float(const Mesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Vec3& v) { return geom::to_float32(v) == v; });
}

template <class T>
void append(std::vector<std::uint8_t>& bytes, const T& value) {
  const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

}  // namespace

Mesh from_ply(std::span<const std::uint8_t> bytes, const std::string& name) {
  return from_ply(bytes, name, {});
}

Mesh from_ply(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress) {
  const Header header = HeaderReader(bytes, name).read();
  switch (header.coding) {
    case Coding::Ascii:
      return BodyReader(TextValues(bytes, header, name), progress).read(header);
    case Coding::Little:
      return BodyReader(BinaryValues<false>(bytes, header, name), progress).read(header);
    default:
      return BodyReader(BinaryValues<true>(bytes, header, name), progress).read(header);
  }
}

std::vector<std::uint8_t> to_ply(const Mesh& mesh) {
  validate(mesh);
  const bool small = exact_in_float(mesh);
  const std::string type = small ? "float" : "double";
  const std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment PLY by Riffler; lengths in mm\nelement vertex " +
      std::to_string(mesh.vertices.size()) + "\nproperty " + type + " x\nproperty " + type + " y\nproperty " + type +
      " z\nelement face " + std::to_string(mesh.triangles.size()) +
      "\nproperty list uchar int vertex_indices\nend_header\n";
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  bytes.reserve(header.size() + (small ? 12 : 24) * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (const Vec3& v : mesh.vertices)
    for (int k = 0; k < 3; ++k)
      if (small)
        append(bytes, static_cast<float>(v[k] + 0));
      else
        append(bytes, v[k] + 0);
  for (const Vec3i& t : mesh.triangles) {
    bytes.push_back(3);
    for (int k = 0; k < 3; ++k) append(bytes, std::int32_t{t[k]});
  }
  return bytes;
}

}  // namespace riffler::mesh
