#include "stress/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <vector>

#include "bench/mesh_distance.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "stress/float_audit.hpp"
#include "stress/thread_count.hpp"

namespace riffler::stress {

namespace {

/// Lattice points that are inside by two of three rays, or by the only ray.
class Points {
 public:
  explicit Points(const Volume& volume) {
    const dexel::Frame& frame = volume.frame();
    for (int k = 0; k < 3; ++k) n_[k] = dexel::ray_count(frame.box.size()[k], frame.pitch);
    votes_.assign(static_cast<std::size_t>(n_.x) * n_.y * n_.z, 0);
    for (const dexel::Grid& grid : volume.grids())
      for (int i = 0; i < grid.nu(); ++i)
        for (int j = 0; j < grid.nv(); ++j)
          for (const dexel::Span& s : grid.ray(i, j)) vote(grid, i, j, s);
    needed_ = volume.grids().size() == 3 ? 2 : 1;
  }
  bool inside(int i, int j, int k) const {
    if (i < 0 || j < 0 || k < 0 || i >= n_.x || j >= n_.y || k >= n_.z) return false;
    return votes_[(static_cast<std::size_t>(i) * n_.y + j) * n_.z + k] >= needed_;
  }
  /// Number of points, and number of cells that have corners both inside and outside.
  std::pair<double, double> count() const {
    double points = 0, cells = 0;
    for (int i = -1; i < n_.x; ++i)
      for (int j = -1; j < n_.y; ++j)
        for (int k = -1; k < n_.z; ++k) {
          int in = 0;
          for (int c = 0; c < 8; ++c) in += inside(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
          cells += in > 0 && in < 8, points += inside(i, j, k);
        }
    for (int i = 0; i < n_.x; ++i)  // the last planes
      for (int j = 0; j < n_.y; ++j)
        for (int k = 0; k < n_.z; ++k) points += (i == n_.x - 1 || j == n_.y - 1 || k == n_.z - 1) && inside(i, j, k);
    return {points, cells};
  }

 private:
  void vote(const dexel::Grid& grid, int i, int j, const dexel::Span& s) {
    const double h = grid.pitch();
    const int last = n_[static_cast<int>(grid.axis())] - 1;
    // If the box is one ray wide, the plane of points is in its middle.
    const double low = last == 0 ? (grid.box().lower.z + grid.box().upper.z - h) / 2 : grid.box().lower.z;
    const int from = std::max(0, static_cast<int>(std::clamp((s.near - low) / h - 0.5, -2.0, last + 2.0)));
    for (int k = from; k <= last && low + (k + 0.5) * h < s.far; ++k)
      if (low + (k + 0.5) * h > s.near) {
        const Vec3 p = to_world(grid.axis(), Vec3(i, j, k));
        ++votes_[(static_cast<std::size_t>(p.x) * n_.y + static_cast<std::size_t>(p.y)) * n_.z +
                 static_cast<std::size_t>(p.z)];
      }
  }
  Vec3i n_;
  std::vector<std::uint8_t> votes_;
  int needed_;
};

Problem check_volume(const Volume& volume, const Mesh& mesh) {
  // The surface stays in the cells that it crosses, or within half a cell of them.
  const auto [points, cells] = Points(volume).count();
  const double h = volume.frame().pitch, cube = h * h * h;
  double allowed = 2 * cells * cube, expected = points * cube;
  if (volume.grids().size() == 1) {  // surfaces across the rays stay between two points: each end is off by at most h/2
    // Walls are half a pitch from the rays, also at the border.
    expected = 0;
    for (std::size_t t = 0; t < volume.reference().tile_count(); ++t)
      for (const dexel::Span& s : volume.reference().tile(t).spans) expected += s.length() * h * h;
    allowed = static_cast<double>(volume.reference().span_count()) * cube;
  }
  // Vertices are on a float32 grid, which is coarse far from the origin.
  const Vec3 reach = glm::max(glm::abs(volume.frame().box.lower), glm::abs(volume.frame().box.upper)) + Vec3(h);
  const double step = std::exp2(std::ceil(std::log2(std::max({reach.x, reach.y, reach.z}))) - 24);
  allowed += 2 * step * area(mesh) + 1e-9 * cube;
  const double found = mesh.empty() ? 0 : enclosed(mesh);
  if (std::abs(found - expected) <= 1.001 * allowed) return {};
  std::ostringstream out;
  out << "the mesh holds " << found << " mm³, the volume " << expected << " ± " << allowed;
  return out.str();
}

/// The largest distance of points of one mesh from another. Each triangle has its corners and points inside, the
/// more of them the longer it is compared with the other mesh's triangles.
double farthest(const Mesh& of, const Mesh& from) {
  constexpr int kMostSteps = 12;
  const bench::MeshDistance distance(from);
  const double step = std::sqrt(area(from) / static_cast<double>(from.triangles.size()));
  double worst = 0;
  int near = 0;
  const auto look_at = [&](const Vec3& p) { worst = std::max(worst, distance(p, worst, &near)); };
  for (const Vec3i& t : of.triangles) {
    const Vec3 &a = of.vertices[t.x], &b = of.vertices[t.y], &c = of.vertices[t.z];
    const double longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
    const int n = static_cast<int>(std::clamp(std::ceil(longest / step), 1.0, static_cast<double>(kMostSteps)));
    look_at(a), look_at(b), look_at(c);
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) look_at(a + (i + 1.0 / 3) / n * (b - a) + (j + 1.0 / 3) / n * (c - a));
  }
  return worst;
}

struct Piece {
  std::size_t grid;
  int i, j;
  dexel::Span span;
  dexel::SpanNormals normals;
};

std::vector<Piece> pieces_of(const Volume& volume) {
  std::vector<Piece> out;
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    const dexel::Grid& grid = volume.grids()[g];
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j) {
        const auto spans = grid.ray(i, j);
        const auto normals = grid.ray_normals(i, j);
        for (std::size_t n = 0; n < spans.size(); ++n)
          out.push_back({g, i, j, spans[n], normals.empty() ? dexel::SpanNormals{} : normals[n]});
      }
  }
  return out;
}

Volume built(const dexel::Frame& frame, const std::vector<Piece>& pieces) {
  Volume volume(frame);
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    dexel::Grid& grid = volume.grids()[g];
    std::vector<std::vector<const Piece*>> rays(static_cast<std::size_t>(grid.nu()) * grid.nv());
    for (const Piece& p : pieces)
      if (p.grid == g) rays[static_cast<std::size_t>(p.i) * grid.nv() + p.j].push_back(&p);
    for (std::size_t t = 0; t < grid.tile_count(); ++t)
      grid.fill_tile(t, [&](int i, int j, dexel::TileBuilder& builder) {
        for (const Piece* p : rays[static_cast<std::size_t>(i) * grid.nv() + j]) builder.add(p->span, p->normals);
      });
  }
  volume.touch();
  return volume;
}

}  // namespace

Problem check_mesh(const Volume& volume, bool threads, std::size_t* triangles) {
  Mesh mesh;
  {
    const ThreadCount one("1");
    mesh = marching::to_mesh(volume);
  }
  if (triangles) *triangles = mesh.triangles.size();
  const FloatAudit audit = float_audit(mesh);
  if (!audit.clean()) {
    std::ostringstream out;
    out << audit;
    return out.str();
  }
  if (Problem p = check_volume(volume, mesh); !p.empty()) return p;
  if (!threads) return {};
  const ThreadCount four("4");
  const Mesh again = marching::to_mesh(volume);
  if (again.vertices != mesh.vertices || again.triangles != mesh.triangles) return "4 threads give another mesh than 1";
  return {};
}

Problem check_within(const Mesh& mesh, const Mesh& full, double tolerance) {
  std::ostringstream out;
  if (const FloatAudit audit = float_audit(mesh); !audit.clean()) {
    out << audit;
    return out.str();
  }
  if (mesh.empty() != full.empty() || mesh.triangles.size() > full.triangles.size()) {
    out << mesh.triangles.size() << " triangles instead of at most " << full.triangles.size();
    return out.str();
  }
  if (full.empty()) return {};
  // Distances are exact to some ulps of the coordinates.
  const Box3 box = box_of(full);
  const Vec3 reach = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  const double ulps = 1e-14 * std::max({reach.x, reach.y, reach.z, 1.0});
  const double there = farthest(mesh, full), back = farthest(full, mesh);
  if (!(std::max(there, back) <= tolerance + ulps)) {
    out << "the mesh is up to " << there << " mm from the full one, which is up to " << back
        << " mm from it; the tolerance is " << tolerance << " mm";
    return out.str();
  }
  // Each point moves by at most the tolerance.
  const double allowed = area(full) * (tolerance * (1 + 1e-6) + 1e-9), held = enclosed(mesh), expected = enclosed(full);
  if (std::abs(held - expected) <= allowed) return {};
  out << "the mesh holds " << held << " mm³, the full one " << expected << " ± " << allowed;
  return out.str();
}

Problem check_tolerance(const Volume& volume, double tolerance, bool threads, std::size_t* triangles) {
  Mesh full, mesh;
  {
    const ThreadCount one("1");
    full = marching::to_mesh(volume), mesh = marching::to_mesh(volume, tolerance);
  }
  if (triangles) *triangles = mesh.triangles.size();
  if (Problem p = check_within(mesh, full, tolerance); !p.empty() || !threads) return p;
  const ThreadCount four("4");
  const Mesh again = marching::to_mesh(volume, tolerance);
  if (again.vertices != mesh.vertices || again.triangles != mesh.triangles)
    return "with a tolerance, 4 threads give another mesh than 1";
  return {};
}

Volume minimised(const Volume& volume, const std::function<bool(const Volume&)>& fails) {
  const dexel::Frame frame = volume.frame();
  std::vector<Piece> pieces = pieces_of(volume);
  // Zeller and Hildebrandt, "Simplifying and Isolating Failure-Inducing Input", 2002, by complements only.
  for (std::size_t chunk = (pieces.size() + 1) / 2; chunk > 0; chunk = chunk > 1 ? (chunk + 1) / 2 : 0) {
    bool again = true;
    while (again) {
      again = false;
      for (std::size_t at = 0; at < pieces.size();) {
        std::vector<Piece> fewer(pieces.begin(), pieces.begin() + static_cast<std::ptrdiff_t>(at));
        fewer.insert(fewer.end(), pieces.begin() + static_cast<std::ptrdiff_t>(std::min(at + chunk, pieces.size())),
                     pieces.end());
        if (fails(built(frame, fewer)))
          pieces = std::move(fewer), again = chunk == 1;
        else
          at += chunk;
      }
    }
  }
  return built(frame, pieces);
}

}  // namespace riffler::stress
