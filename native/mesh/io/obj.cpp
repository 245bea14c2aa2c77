#include "mesh/io/obj.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "mesh/io/scan.hpp"
#include "mesh/weld.hpp"
#include "riffler/base/error.hpp"

namespace riffler::mesh {

namespace {

/// Statements without content for a mesh of triangles (Wavefront, Advanced Visualizer manual, appendix B1).
constexpr std::array<std::string_view, 41> kPassedOver = {
    "vt",    "vn",    "vp",       "deg",      "bmat", "step",   "cstype", "p",        "l",      "curv",       "curv2",
    "surf",  "parm",  "trim",     "hole",     "scrv", "sp",     "end",    "con",      "g",      "s",          "mg",
    "o",     "bevel", "c_interp", "d_interp", "lod",  "usemap", "maplib", "usemtl",   "mtllib", "shadow_obj", "ctech",
    "stech", "call",  "csh",      "bsp",      "bzp",  "cdc",    "cdp",    "trace_obj"};

class ObjReader {
 public:
  ObjReader(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress)
      : scan_(bytes, name), size_(bytes.size()), progress_(progress) {}

  Mesh read() {
    for (std::size_t n = 0; !scan_.at_end(); scan_.next_line(), ++n) {
      if (n % kStatementsAReport == 0)
        base::report(progress_, static_cast<double>(scan_.offset()) / static_cast<double>(size_));
      statement();
    }
    if (mesh_.triangles.empty()) scan_.fail("zero faces");
    mesh_.vertices.assign(welder_.points().begin(), welder_.points().end());
    return std::move(mesh_);
  }

 private:
  void statement() {
    const std::string_view word = scan_.token_in_line();
    if (word.empty()) return;
    if (word == "v") {
      vertex();
    } else if (word == "f" || word == "fo") {  // "fo" is the version 2 form
      face();
    } else if (!word.starts_with('#')) {
      if (std::find(kPassedOver.begin(), kPassedOver.end(), word) == kPassedOver.end())
        scan_.fail_expected("a statement", word);
      pass_over();
    }
  }

  /// Skips the rest of a statement, which may contain anything, even a backslash in a name.
  void pass_over() {
    std::string_view last;
    for (;;) {
      const std::string_view word = scan_.token_in_line();
      if (word.empty() && (!last.ends_with('\\') || scan_.at_end())) return;
      if (word.empty()) scan_.next_line();
      last = word;
    }
  }

  /// The next token of this statement. A lone backslash at the end of a line continues the statement.
  std::string_view next() {
    for (;;) {
      std::string_view word = scan_.token_in_line();
      if (!word.ends_with('\\')) return word;
      word.remove_suffix(1);
      if (scan_.at_end()) return word;
      if (!scan_.token_in_line().empty()) scan_.fail("a backslash within the line");
      scan_.next_line();
      if (!word.empty()) return word;
    }
  }

  void vertex() {
    Vec3 v;
    for (int k = 0; k < 3; ++k) v[k] = coordinate(next());
    // A weight or a colour may follow.
    for (std::string_view word = next(); !word.empty(); word = next())
      if (!to_number(word) && !is_not_a_number(word)) scan_.fail_expected("a number", word);
    welded_.push_back(welder_.add(v));
  }

  double coordinate(std::string_view word) {
    const std::optional<double> x = to_number(word);
    if (!x) scan_.fail_expected("a finite coordinate", word);
    if (!(std::abs(*x) <= 1e30)) scan_.fail("a vertex's coordinate is beyond 1e30");
    return *x;
  }

  void face() {
    corners_.clear();
    for (std::string_view word = next(); !word.empty(); word = next()) corners_.push_back(corner(word));
    if (corners_.size() < 3) scan_.fail("a face with fewer than three vertices");
    for (std::size_t k = 2; k < corners_.size(); ++k)
      mesh_.triangles.emplace_back(corners_[0], corners_[k - 1], corners_[k]);
  }

  int corner(std::string_view word) {
    const std::size_t slash = word.find('/');
    const std::optional<std::int64_t> index = to_integer(word.substr(0, slash));
    if (!index) scan_.fail_expected("a vertex's index", word);
    if (slash != word.npos) check_rest(word, word.substr(slash + 1));
    const auto n = static_cast<std::int64_t>(welded_.size());
    const std::int64_t i = *index < 0 ? n + *index : *index - 1;
    if (*index == 0 || i < 0 || i >= n)
      scan_.fail("no vertex " + std::to_string(*index) + ": " + std::to_string(n) + " are defined so far");
    return welded_[static_cast<std::size_t>(i)];
  }

  /// Checks the rest of an index: vt, /vn or vt/vn.
  void check_rest(std::string_view word, std::string_view rest) {
    const std::size_t slash = rest.find('/');
    const std::string_view vt = rest.substr(0, slash);
    const std::string_view vn = slash == rest.npos ? std::string_view() : rest.substr(slash + 1);
    if ((!vt.empty() && !to_integer(vt)) || (!vn.empty() && !to_integer(vn)))
      scan_.fail_expected("v, v/vt, v//vn or v/vt/vn", word);
  }

  static constexpr std::size_t kStatementsAReport = 1 << 14;

  Scanner scan_;
  std::size_t size_;
  const Progress& progress_;
  Welder<Vec3> welder_;
  std::vector<int> welded_, corners_;  // welded_: vertex of the file → vertex of the mesh
  Mesh mesh_;
};

}  // namespace

Mesh from_obj(std::span<const std::uint8_t> bytes, const std::string& name) {
  return from_obj(bytes, name, {});
}

Mesh from_obj(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress) {
  return ObjReader(bytes, name, progress).read();
}

std::vector<std::uint8_t> to_obj(const Mesh& mesh) {
  validate(mesh);
  constexpr std::string_view kTitle = "# OBJ by Riffler; lengths in mm\n";
  std::vector<std::uint8_t> bytes(kTitle.begin(), kTitle.end());
  bytes.reserve(bytes.size() + 40 * mesh.vertices.size() + 24 * mesh.triangles.size());
  std::array<char, 32> number;
  const auto append = [&](auto value) {
    bytes.push_back(' ');
    char* const end = std::to_chars(number.data(), number.data() + number.size(), value).ptr;
    bytes.insert(bytes.end(), number.data(), end);
  };
  for (const Vec3& v : mesh.vertices) {
    bytes.push_back('v');
    for (int k = 0; k < 3; ++k) append(v[k] + 0.0);
    bytes.push_back('\n');
  }
  for (const Vec3i& t : mesh.triangles) {
    bytes.push_back('f');
    for (int k = 0; k < 3; ++k) append(std::int64_t{t[k]} + 1);
    bytes.push_back('\n');
  }
  return bytes;
}

}  // namespace riffler::mesh
