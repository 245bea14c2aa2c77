// Queries of Coal (the wheel on PyPI has headers and library): the part is a tree of Coal's boxes and spheres, the tool
// another such tree or four shapes.
#include <coal/BVH/BVH_model.h>
#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/shape/geometric_shapes.h>

#include <memory>

#include "bench/contact_rivals.hpp"
#include "bench/process.hpp"
#include "geom/math.hpp"

namespace riffler::bench {

namespace {

using Tree = coal::BVHModel<coal::OBBRSS>;

constexpr std::size_t kAll = 1 << 30;  // contacts

coal::Vec3s to_coal(const Vec3& v) {
  return {v.x, v.y, v.z};
}

std::shared_ptr<Tree> tree(const Mesh& mesh) {
  std::vector<coal::Vec3s> vertices;
  std::vector<coal::Triangle> triangles;
  for (const Vec3& v : mesh.vertices) vertices.push_back(to_coal(v));
  for (const Vec3i& t : mesh.triangles)
    triangles.emplace_back(static_cast<std::size_t>(t.x), static_cast<std::size_t>(t.y), static_cast<std::size_t>(t.z));
  auto out = std::make_shared<Tree>();
  out->beginModel();
  out->addSubModel(vertices, triangles);
  out->endModel();
  return out;
}

/// A frame of the tool; the rotation about its axis is arbitrary.
coal::Transform3s place(const Pose& pose) {
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(to_coal(pose.axis)));
  return {turn.toRotationMatrix(), to_coal(pose.tip)};
}

struct Shape {
  std::shared_ptr<coal::CollisionGeometry> geometry;
  coal::Transform3s in_tool;
};

/// The same four shapes as for FCL. A cone's tip is at the top in Coal, at the bottom in a tool.
std::vector<Shape> shapes(const Tool& tool) {
  const double r = tool.diameter() / 2;
  const auto up = [](double z) { return coal::Transform3s(coal::Vec3s(0, 0, z)); };
  if (tool.shank().empty())
    return {{std::make_shared<coal::Sphere>(r), up(r)},
            {std::make_shared<coal::Cylinder>(r, tool.length() - r), up((r + tool.length()) / 2)}};
  const tool::Frustum &shank = tool.shank()[0], &taper = tool.shank()[1], &holder = tool.holder()[0];
  const double cone = taper.r1 * (taper.z1 - taper.z0) / (taper.r1 - taper.r0);
  const coal::Transform3s over(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()).toRotationMatrix(),
                               coal::Vec3s(0, 0, taper.z1 - cone / 2));
  return {{std::make_shared<coal::Sphere>(r), up(r)},
          {std::make_shared<coal::Cylinder>(r, shank.z1 - r), up((r + shank.z1) / 2)},
          {std::make_shared<coal::Cone>(taper.r1, cone), over},
          {std::make_shared<coal::Cylinder>(holder.r0, holder.z1 - holder.z0), up((holder.z0 + holder.z1) / 2)}};
}

double contacts(const Tree& part, const coal::CollisionGeometry& tool, const coal::Transform3s& at, std::size_t most) {
  coal::CollisionResult result;
  coal::collide(&part, coal::Transform3s(), &tool, at, coal::CollisionRequest(coal::NO_REQUEST, most), result);
  return static_cast<double>(result.numContacts());
}

}  // namespace

std::vector<Ask> coal_asks(const ContactCase& scene) {
  const Stopwatch clock;
  const auto part = tree(scene.part), tool = tree(scene.tool_mesh);
  const double build_s = clock.cpu();
  const auto four = shapes(scene.tool);
  std::vector<Ask> asks;
  for (const std::size_t most : {kAll, std::size_t{1}}) {
    const char* what = most == 1 ? "first contact" : "all contacts";
    asks.push_back({"Coal OBBRSS, tool mesh", what,
                    [=](const Pose& pose) { return contacts(*part, *tool, place(pose), most); }, build_s});
    asks.push_back({"Coal OBBRSS, four shapes", what,
                    [=](const Pose& pose) {
                      const coal::Transform3s at = place(pose);
                      double count = 0;
                      for (const Shape& shape : four) {
                        count += contacts(*part, *shape.geometry, at * shape.in_tool, most);
                        if (count >= static_cast<double>(most)) break;
                      }
                      return count;
                    },
                    build_s});
  }
  asks.push_back({"Coal OBBRSS, tool mesh", "signed distance",
                  [=](const Pose& pose) {
                    coal::DistanceResult result;
                    return static_cast<double>(coal::distance(part.get(), coal::Transform3s(), tool.get(), place(pose),
                                                              coal::DistanceRequest(false, true), result));
                  },
                  build_s, 100});
  asks.push_back({"Coal OBBRSS, four shapes", "signed distance",
                  [=](const Pose& pose) {
                    const coal::Transform3s at = place(pose);
                    double least = 1e300;
                    for (const Shape& shape : four) {
                      coal::DistanceResult result;
                      least = std::min(least, static_cast<double>(coal::distance(
                                                  part.get(), coal::Transform3s(), shape.geometry.get(),
                                                  at * shape.in_tool, coal::DistanceRequest(false, true), result)));
                    }
                    return least;
                  },
                  build_s, 50});
  return asks;
}

}  // namespace riffler::bench
