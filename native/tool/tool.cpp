#include "riffler/tool/tool.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geom/hypot.hpp"
#include "riffler/base/check.hpp"

namespace riffler::tool {

namespace {

void check_frusta(const std::vector<Frustum>& pieces, const char* what) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Frustum& f = pieces[i];
    const std::string where = std::string(what) + " piece " + std::to_string(i) + ": ";
    for (const double x : {f.z0, f.r0, f.z1, f.r1})
      if (!std::isfinite(x)) throw std::invalid_argument(where + "not finite");
    if (!(f.z0 < f.z1)) throw std::invalid_argument(where + "z0 must be less than z1");
    if (f.r0 < 0 || f.r1 < 0 || f.r0 + f.r1 <= 0)
      throw std::invalid_argument(where + "radii must not be negative, nor both 0");
  }
}

/// A frustum with its side moved out by `side` and its ends by `ends`; the side is extended in a straight line.
Frustum grown(const Frustum& f, double side, double ends) {
  const double slope = (f.r1 - f.r0) / (f.z1 - f.z0), out = side * std::sqrt(1 + slope * slope);
  return {f.z0 - ends, f.r0 - slope * ends + out, f.z1 + ends, f.r1 + slope * ends + out};
}

std::string short_number(double x) {
  std::string text = std::to_string(x);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

Tool::Tool(std::string kind, std::vector<std::pair<std::string, double>> parameters, Profile profile)
    : kind_(std::move(kind)),
      parameters_(std::move(parameters)),
      profile_(std::move(profile)),
      cutter_(profile_->pieces()) {
  name_ = kind_ + " " + short_number(diameter());
}

Tool::Tool(std::string kind, std::vector<std::pair<std::string, double>> parameters, std::vector<Hull> hulls)
    : kind_(std::move(kind)),
      parameters_(std::move(parameters)),
      hulls_(std::make_shared<const std::vector<Hull>>(std::move(hulls))) {
  const auto width =
      std::find_if(parameters_.begin(), parameters_.end(), [](const auto& p) { return p.first == "width"; });
  name_ = kind_ + " " + short_number(width == parameters_.end() ? diameter() : width->second);
}

const std::vector<Hull>& Tool::hulls() const {
  static const std::vector<Hull> none;
  return hulls_ ? *hulls_ : none;
}

void Tool::require_revolved(std::string_view who) const {
  if (revolved()) return;
  throw std::invalid_argument(
      std::string(who) + " cannot use the hand tool \"" + name_ +
      "\", which is no body of revolution: Volume.carve, History and Journal can; use a ball, a " +
      "flat or another tool with a profile here");
}

const Profile& Tool::profile() const {
  require_revolved("what needs a tool's profile");
  return *profile_;
}

const std::vector<Piece>& Tool::cutter() const {
  require_revolved("what needs a tool's profile");
  return cutter_;
}

double Tool::diameter() const {
  if (profile_) return 2 * profile_->max_radius();
  double radius = 0;
  for (const Hull& hull : *hulls_)
    for (const Vec3& p : hull.vertices) radius = std::max(radius, geom::hypot(p.x, p.y));
  return 2 * radius;
}

double Tool::length() const {
  if (profile_) return profile_->length();
  double height = 0;
  for (const Hull& hull : *hulls_)
    for (const Vec3& p : hull.vertices) height = std::max(height, p.z);
  return height;
}

Tool Tool::with_shank(const std::vector<Frustum>& pieces) const {
  require_revolved("with_shank");
  check_frusta(pieces, "shank");
  Tool tool = *this;
  tool.shank_ = pieces;
  return tool;
}

Tool Tool::with_holder(const std::vector<Frustum>& pieces) const {
  require_revolved("with_holder");
  check_frusta(pieces, "holder");
  Tool tool = *this;
  tool.holder_ = pieces;
  return tool;
}

Tool Tool::with_margins(double shank, double holder) const {
  for (const auto& [name, margin] : {std::pair("shank", shank), std::pair("holder", holder)})
    base::require_not_negative(margin, name, base::kFiniteAndNotNegative);
  Tool tool = *this;
  for (Frustum& f : tool.shank_) f = grown(f, shank, 0);
  for (Frustum& f : tool.holder_) f = grown(f, holder, holder);
  return tool;
}

Tool Tool::named(std::string name) const {
  Tool tool = *this;
  tool.name_ = std::move(name);
  return tool;
}

std::vector<ToolPiece> Tool::assembly() const {
  require_revolved("what needs a tool's profile");
  std::vector<ToolPiece> all;
  for (const Piece& p : cutter_) all.push_back({Part::Cutter, p});
  for (const Frustum& f : shank_) all.push_back({Part::Shank, f});
  for (const Frustum& f : holder_) all.push_back({Part::Holder, f});
  return all;
}

}  // namespace riffler::tool
