#include "nc/apt_cutter.hpp"

#include <stdexcept>
#include <string>

#include "geom/math.hpp"

namespace riffler::nc {

std::optional<Tool> apt_cutter(std::vector<double> v, double unit, const NcPlace& place) {
  if (v.size() != 7) return std::nullopt;
  const tool::AptCutter apt{v[0] * unit,    v[1] * unit,    v[2] * unit, v[3] * unit,
                            v[4] * kDegree, v[5] * kDegree, v[6] * unit};
  try {
    for (const tool::CutterShape& shape : tool::cutter_shapes())
      if (shape.from_apt)
        if (const auto sizes = shape.from_apt(apt)) return make_cutter(shape, *sizes);
  } catch (const std::invalid_argument& e) {
    place.fail(std::string("CUTTER: ") + e.what());
  }
  return std::nullopt;
}

std::optional<tool::AptCutter> to_apt(const Tool& tool) {
  const tool::CutterShape* shape = tool::find_cutter_shape(tool.kind());
  if (!shape || !shape->to_apt) return std::nullopt;
  const auto sizes = sizes_of(tool, *shape);
  return sizes ? std::optional(shape->to_apt(*sizes)) : std::nullopt;
}

}  // namespace riffler::nc
