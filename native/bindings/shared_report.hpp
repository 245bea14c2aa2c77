// Verifications as Python holds them, for riffler.verify and for clusters.
#pragma once

#include <memory>

#include "bindings/bindings.hpp"
#include "bindings/shared_volume.hpp"
#include "verify/verification.hpp"

namespace riffler {

/// A report as Python holds it. The maps take as long as the meshes are large, so they are made when first asked for.
struct SharedReport {
  VerifyReport report;
  py::object left, deviation, part_map;  // None until then
};
std::shared_ptr<SharedReport> share(VerifyReport&& report);

VerifyOptions to_verify_options(double tolerance, double gouge_tolerance, const std::optional<double>& rest_tolerance,
                                double rapid_feed, const std::optional<std::string>& machine,
                                const py::object& machine_options);

/// From riffler.verify's arguments; ValueError naming the one that is wrong. Called with the GIL, computes without.
std::unique_ptr<Verification> make_verification(SharedVolume& stock, const py::object& part, const py::object& fixtures,
                                                const py::object& tools, const VerifyOptions& options,
                                                const Progress& progress);

}  // namespace riffler
