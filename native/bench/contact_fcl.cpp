// Queries of FCL (Debian's libfcl-dev): part and tool are trees of oriented boxes, or the tool is four of FCL's shapes.
#include <fcl/fcl.h>

#include <memory>

#include "bench/contact_rivals.hpp"
#include "bench/process.hpp"
#include "geom/math.hpp"

namespace riffler::bench {

namespace {

using Vector = fcl::Vector3d;
using Place = fcl::Transform3d;

constexpr std::size_t kAll = 1 << 30;  // contacts

Vector to_fcl(const Vec3& v) {
  return {v.x, v.y, v.z};
}

template <class Box>
std::shared_ptr<fcl::BVHModel<Box>> tree(const Mesh& mesh) {
  std::vector<Vector> vertices;
  std::vector<fcl::Triangle> triangles;
  for (const Vec3& v : mesh.vertices) vertices.push_back(to_fcl(v));
  for (const Vec3i& t : mesh.triangles)
    triangles.emplace_back(static_cast<std::size_t>(t.x), static_cast<std::size_t>(t.y), static_cast<std::size_t>(t.z));
  auto out = std::make_shared<fcl::BVHModel<Box>>();
  out->beginModel();
  out->addSubModel(vertices, triangles);
  out->endModel();
  return out;
}

/// A frame of the tool; the rotation about its axis is arbitrary.
Place place(const Pose& pose) {
  Place out = Place::Identity();
  out.linear() = Eigen::Quaterniond::FromTwoVectors(Vector::UnitZ(), to_fcl(pose.axis)).toRotationMatrix();
  out.translation() = to_fcl(pose.tip);
  return out;
}

struct Shape {
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  double middle;  // height above the tip
};

std::shared_ptr<fcl::CollisionGeometryd> cylinder(double r, double length) {
  return std::make_shared<fcl::Cylinderd>(r, length);
}

/// Ball, cylinder of cutter and shank, taper and holder. Their union is the tool, because the taper's whole cone
/// reaches no further than the shank.
std::vector<Shape> shapes(const Tool& tool) {
  const double r = tool.diameter() / 2;
  if (tool.shank().empty())
    return {{std::make_shared<fcl::Sphered>(r), r}, {cylinder(r, tool.length() - r), (r + tool.length()) / 2}};
  const tool::Frustum &shank = tool.shank()[0], &taper = tool.shank()[1], &holder = tool.holder()[0];
  const double cone = taper.r1 * (taper.z1 - taper.z0) / (taper.r1 - taper.r0);
  return {{std::make_shared<fcl::Sphered>(r), r},
          {cylinder(r, shank.z1 - r), (r + shank.z1) / 2},
          {std::make_shared<fcl::Coned>(taper.r1, cone), taper.z1 - cone / 2},
          {cylinder(holder.r0, holder.z1 - holder.z0), (holder.z0 + holder.z1) / 2}};
}

/// A cone's tip is at the top in FCL, at the bottom in a tool.
Place at(const Place& tool, const Shape& shape) {
  Place out = tool * Eigen::Translation3d(0, 0, shape.middle);
  if (shape.geometry->getNodeType() == fcl::GEOM_CONE) out = out * Eigen::AngleAxisd(kPi, Vector::UnitX());
  return out;
}

template <class Box>
void add_meshes(const ContactCase& scene, const std::string& engine, std::vector<Ask>& asks) {
  const Stopwatch clock;
  const auto part = tree<Box>(scene.part), tool = tree<Box>(scene.tool_mesh);
  const double build_s = clock.cpu();
  for (const std::size_t most : {kAll, std::size_t{1}})
    asks.push_back({engine + ", tool mesh", most == 1 ? "first contact" : "all contacts",
                    [=](const Pose& pose) {
                      fcl::CollisionResultd result;
                      fcl::collide<double>(part.get(), Place::Identity(), tool.get(), place(pose),
                                           fcl::CollisionRequestd(most, false), result);
                      return static_cast<double>(result.numContacts());
                    },
                    build_s});
}

}  // namespace

std::vector<Ask> fcl_asks(const ContactCase& scene) {
  std::vector<Ask> asks;
  add_meshes<fcl::OBBd>(scene, "FCL OBB", asks);
  add_meshes<fcl::OBBRSSd>(scene, "FCL OBBRSS", asks);
  const Stopwatch clock;
  const auto boxes = tree<fcl::OBBd>(scene.part);
  const double build_s = clock.cpu();
  const auto four = shapes(scene.tool);
  for (const std::size_t most : {kAll, std::size_t{1}})
    asks.push_back({"FCL OBB, four shapes", most == 1 ? "first contact" : "all contacts",
                    [=](const Pose& pose) {
                      const Place tool = place(pose);
                      std::size_t count = 0;
                      for (const Shape& shape : four) {
                        fcl::CollisionResultd result;
                        fcl::collide<double>(boxes.get(), Place::Identity(), shape.geometry.get(), at(tool, shape),
                                             fcl::CollisionRequestd(most, false), result);
                        count += result.numContacts();
                        if (count >= most) break;
                      }
                      return static_cast<double>(count);
                    },
                    build_s});
  const auto spheres = tree<fcl::OBBRSSd>(scene.part);
  const auto tool_tree = tree<fcl::OBBRSSd>(scene.tool_mesh);
  fcl::DistanceRequestd request;
  request.enable_signed_distance = true;
  asks.push_back({"FCL OBBRSS, tool mesh", "signed distance",
                  [=](const Pose& pose) {
                    fcl::DistanceResultd result;
                    fcl::distance<double>(spheres.get(), Place::Identity(), tool_tree.get(), place(pose), request,
                                          result);
                    return result.min_distance;
                  },
                  0, 100});
  asks.push_back({"FCL OBBRSS, four shapes", "signed distance",
                  [=](const Pose& pose) {
                    const Place tool = place(pose);
                    double least = 1e300;
                    for (const Shape& shape : four) {
                      fcl::DistanceResultd result;
                      fcl::distance<double>(spheres.get(), Place::Identity(), shape.geometry.get(), at(tool, shape),
                                            request, result);
                      least = std::min(least, result.min_distance);
                    }
                    return least;
                  },
                  0, 50});
  return asks;
}

}  // namespace riffler::bench
