// Results of several values: frozen dataclasses of riffler.results, made here.
#pragma once

#include "bindings/bindings.hpp"
#include "bindings/typed.hpp"

namespace riffler::bindings {

RIFFLER_TYPED(AuditResult, "riffler.results.Audit")
RIFFLER_TYPED(MeshAndOrientation, "tuple[riffler._core.Mesh, riffler.results.Orientation]")
RIFFLER_TYPED(VolumeAndReport, "tuple[riffler._core.Volume, riffler.results.VolumeReport]")
RIFFLER_TYPED(MeshAndReport, "tuple[riffler._core.Mesh, riffler.results.SurfaceReport]")
RIFFLER_TYPED(VolumeCountersResult, "riffler.results.VolumeCounters")
RIFFLER_TYPED(PickCountersResult, "riffler.results.PickCounters")
RIFFLER_TYPED(PatchResult, "riffler.results.Patch")
RIFFLER_TYPED(PickResult, "riffler.results.Hit | riffler.results.Hits | None")
RIFFLER_TYPED(NearestResult, "riffler.results.Nearest")

/// <module>.<name>(**fields): a dataclass.
inline py::object make_result(const char* name, const py::dict& fields, const char* module = "riffler.results") {
  return py::module_::import(module).attr(name)(**fields);
}

}  // namespace riffler::bindings
