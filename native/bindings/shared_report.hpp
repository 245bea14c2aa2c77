// Reports of verifications as Python holds them, of riffler.verify and of clusters.
#pragma once

#include <memory>

#include "bindings/lazy_object.hpp"
#include "riffler/verify/report.hpp"

namespace riffler::bindings {

/// A report as Python holds it. The maps take as long as the meshes are large, so they are made when first asked for.
struct SharedReport {
  explicit SharedReport(verify::VerifyReport&& r) : report(std::move(r)) {}
  const verify::VerifyReport report;
  LazyObject stock_deviation, part_deviation;
};
std::shared_ptr<SharedReport> share(verify::VerifyReport&& report);

}  // namespace riffler::bindings
