// The arguments of riffler.verify, which everything that verifies has: the one list of them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bindings/program_types.hpp"
#include "bindings/shared_volume.hpp"
#include "verify/scene.hpp"

namespace riffler::bindings {

/// VerifyArguments as Python gives them: fixtures may be meshes.
struct GivenArguments {
  verify::VerifyArguments others;
  std::vector<std::variant<Volume, std::shared_ptr<const Mesh>>> fixtures;
};

/// On what machine a program is to run.
struct GivenMachine {
  const std::optional<std::string>& name;
  const OptionsLike& options;
  const OptionalArrayLike& frame;
};

/// ValueError naming the one that is wrong. `options` has no machine yet.
GivenArguments to_given(SharedVolume& stock, const std::shared_ptr<Mesh>& part, const FixturesLike& fixtures,
                        const ToolsLike& tools, verify::VerifyOptions options, const GivenMachine& machine);

/// Without the GIL. Meshes become volumes at the stock's pitch. std::invalid_argument naming the fixture.
verify::VerifyArguments to_arguments(const GivenArguments& given, const Progress& progress);

/// T(arguments, progress). Called with the GIL, which it releases.
template <class T>
std::unique_ptr<T> make_of(const GivenArguments& given, const ProgressLike& progress) {
  const Progress listener = to_progress(progress);
  const NoGil release;
  return std::make_unique<T>(to_arguments(given, base::part(listener, 0, 0.5)), base::part(listener, 0.5, 1));
}

/// A function of Python whose last arguments are those of riffler.verify: calls f(first…, given, progress).
template <class... First, class F>
auto with_arguments(const F& f) {
  return [f](const First&... first, SharedVolume& stock, const std::shared_ptr<Mesh>& part_mesh,
             const FixturesLike& fixtures, const ToolsLike& tools, double tolerance, double gouge_tolerance,
             const std::optional<double>& rest_tolerance, double rapid_feed, const std::optional<std::string>& machine,
             const OptionsLike& machine_options, const OptionalArrayLike& machine_frame, const ProgressLike& progress) {
    return f(first...,
             to_given(stock, part_mesh, fixtures, tools, {tolerance, gouge_tolerance, rest_tolerance, rapid_feed, {}},
                      {machine, machine_options, machine_frame}),
             progress);
  };
}

/// Calls define(name…) with what Python calls those arguments, and their defaults.
template <class Define>
void define_with_arguments(const Define& define) {
  define(py::arg("stock_volume"), py::arg("part_mesh") = py::none(), py::arg("fixtures") = py::tuple(), py::kw_only(),
         py::arg("tools") = py::none(), py::arg("tolerance") = 0.01, py::arg("gouge_tolerance") = 0.05,
         py::arg("rest_tolerance") = py::none(), py::arg("rapid_feed") = 10000.0, py::arg("machine") = py::none(),
         py::arg("machine_options") = py::none(), py::arg("machine_frame") = py::none(),
         py::arg("progress") = py::none());
}

}  // namespace riffler::bindings
