// Verifications as Python holds them, for riffler.verify and for clusters.
#pragma once

#include <map>
#include <memory>
#include <variant>
#include <vector>

#include "bindings/lazy_object.hpp"
#include "bindings/shared_volume.hpp"
#include "verify/verification.hpp"

namespace riffler {

/// A report as Python holds it. The maps take as long as the meshes are large, so they are made when first asked for.
struct SharedReport {
  explicit SharedReport(VerifyReport&& r) : report(std::move(r)) {}
  const VerifyReport report;
  LazyObject deviation, part_map;
};
std::shared_ptr<SharedReport> share(VerifyReport&& report);

VerifyOptions to_verify_options(double tolerance, double gouge_tolerance, const std::optional<double>& rest_tolerance,
                                double rapid_feed, const std::optional<std::string>& machine,
                                const py::object& machine_options, const py::object& machine_frame);

/// What riffler.verify is given but for the program.
struct VerifyArguments {
  Volume stock;
  std::shared_ptr<const Mesh> part;  ///< may be null
  std::vector<std::variant<Volume, std::shared_ptr<const Mesh>>> fixtures;
  std::map<int, Tool> tools;
  VerifyOptions options;
};

/// ValueError naming the one that is wrong.
VerifyArguments to_verify_arguments(SharedVolume& stock, const py::object& part, const py::object& fixtures,
                                    const py::object& tools, const VerifyOptions& options);

/// Without the GIL. Throws std::invalid_argument naming the argument.
std::unique_ptr<Verification> make_verification(const VerifyArguments& arguments, const Progress& progress);
/// Called with the GIL, which it releases.
std::unique_ptr<Verification> make_verification_here(const VerifyArguments& arguments, const Progress& progress);

}  // namespace riffler
