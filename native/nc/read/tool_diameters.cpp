#include "nc/read/tool_diameters.hpp"

#include <cmath>
#include <stdexcept>

#include "nc/limits.hpp"
#include "nc/number_text.hpp"

namespace riffler::nc {

namespace {

constexpr const char* kName = "tool_diameters";
constexpr std::size_t kMaxTools = 10'000;

double checked_diameter(double diameter) {
  if (!(std::abs(diameter) <= kMaxLength))
    throw std::invalid_argument("option tool_diameters: a diameter is out of range");
  return diameter;
}

}  // namespace

CompensationRule take_compensation_rule(OptionReader& options) {
  const std::string rule = options.word("cutter_compensation", {"error", "ignore", "offset"}, "error");
  return rule == "ignore"   ? CompensationRule::Ignore
         : rule == "offset" ? CompensationRule::Offset
                            : CompensationRule::Error;
}

std::string compensation_refused(const std::string& code) {
  return "cutter radius compensation (" + code +
         "): where the program has the contour, read it with options {'cutter_compensation': 'offset', "
         "'tool_diameters': 6}, the tool's diameter in mm; where it has the path of the tool's centre, with "
         "{'cutter_compensation': 'ignore'}";
}

std::string compensation_ignored(const std::string& code) {
  return code + " is ignored: points are taken as those of the tool's centre";
}

std::string diameter_unknown(const std::string& code, const std::string& whose, int number) {
  return "cutter compensation (" + code + "): the diameter of " + whose +
         " is not known: give it in mm, as in options {'tool_diameters': {" + std::to_string(number) + ": 6}}";
}

std::string path_is_offset(const std::string& code, const std::string& whose, double radius) {
  return code + " offsets the path by the radius of " + whose + ", " + number_text(radius) + " mm";
}

void ToolDiameters::take(const Options& given, OptionReader& options) {
  const auto found = given.find(kName);
  if (found != given.end() && std::holds_alternative<double>(found->second)) {
    all_ = checked_diameter(options.number(kName, 0));
    return;
  }
  const auto numbers = options.numbers(kName, 2, 2 * kMaxTools);
  if (!numbers) return;
  if (numbers->size() % 2 != 0)
    throw std::invalid_argument("option tool_diameters takes a diameter for each number of a tool, in pairs");
  for (std::size_t k = 0; k < numbers->size(); k += 2) {
    const double number = (*numbers)[k];
    if (!(number >= 0 && number <= kMaxNumber && number == std::floor(number)))
      throw std::invalid_argument("option tool_diameters: the number of a tool must be whole and not negative");
    if (!of_.emplace(static_cast<int>(number), checked_diameter((*numbers)[k + 1])).second)
      throw std::invalid_argument("option tool_diameters has tool " + std::to_string(static_cast<int>(number)) +
                                  " twice");
  }
}

std::optional<double> ToolDiameters::of(int number) const {
  if (all_) return all_;
  const auto found = of_.find(number);
  return found == of_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace riffler::nc
