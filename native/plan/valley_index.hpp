// Index of the valleys traced so far.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "plan/valley.hpp"

namespace riffler::plan {

/// Values at places in space, hashed by cubes of one size.
template <class T>
class Cubes {
 public:
  explicit Cubes(double size) : size_(size) {}

  void add(const Vec3& lower, const Vec3& upper, const T& what) {
    visit(lower, upper, [&](std::uint64_t key) { cubes_[key].push_back(what); });
  }
  /// Calls see(what) for everything added to cubes in this box, possibly more than once.
  template <class See>
  void look(const Vec3& lower, const Vec3& upper, const See& see) const {
    visit(lower, upper, [&](std::uint64_t key) {
      if (const auto found = cubes_.find(key); found != cubes_.end())
        for (const T& what : found->second) see(what);
    });
  }

 private:
  template <class Visit>
  void visit(const Vec3& lower, const Vec3& upper, const Visit& to) const {
    const Vec3 a = glm::floor(lower / size_), b = glm::floor(upper / size_);
    for (double x = a.x; x <= b.x; ++x)
      for (double y = a.y; y <= b.y; ++y)
        for (double z = a.z; z <= b.z; ++z) to(key(x) * 0x9E3779B97F4A7C15 ^ key(y) * 0xC2B2AE3D27D4EB4F ^ key(z));
  }
  static std::uint64_t key(double i) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(i)); }

  double size_;
  std::unordered_map<std::uint64_t, std::vector<T>> cubes_;
};

class ValleyIndex {
 public:
  /// `near` (mm) and `turn` (rad): a place within this distance of a traced valley, with sides that differ by less,
  /// lies on that valley.
  ValleyIndex(double cube, double near, double turn) : segments_(cube), near_(near), turn_(turn) {}

  void add(const Valley& valley);
  bool covers(const Station& station) const;
  /// Whether most of the valley is covered.
  bool covers(const Valley& valley) const;

 private:
  struct Segment {
    Station a, b;
  };
  bool on(const Station& station, const Segment& segment) const;

  Cubes<std::size_t> segments_;
  std::vector<Segment> all_;
  double near_, turn_;
};

}  // namespace riffler::plan
