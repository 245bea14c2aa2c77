// Types of arguments and results of programs, plans, journals, sessions and pens, as signatures and the stub show them.
#pragma once

#include "bindings/bindings.hpp"
#include "bindings/results.hpp"
#include "bindings/typed.hpp"
#include "riffler/base/thread_priority.hpp"

namespace riffler::bindings {

RIFFLER_TYPED(ToolsLike, "collections.abc.Mapping[int, Tool] | None")
RIFFLER_TYPED(ToolListLike, "collections.abc.Iterable[Tool] | None")
RIFFLER_TYPED(StringsLike, "collections.abc.Mapping[str, object] | None")
RIFFLER_TYPED(ViaLike, "collections.abc.Mapping[int, numpy.typing.ArrayLike] | None")
RIFFLER_TYPED(ArraysLike, "collections.abc.Iterable[numpy.typing.ArrayLike]")
RIFFLER_TYPED(PerPathLike, "numpy.typing.ArrayLike | collections.abc.Sequence[numpy.typing.ArrayLike]")
RIFFLER_TYPED(CornersLike, "tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike] | None")
RIFFLER_TYPED(KeysLike, "collections.abc.Mapping[int, numpy.typing.ArrayLike]")
RIFFLER_TYPED(ConeLike, "tuple[numpy.typing.ArrayLike, float] | None")
RIFFLER_TYPED(ProgramLike, "Program | collections.abc.Iterable[Program]")
RIFFLER_TYPED(FixturesLike, "collections.abc.Iterable[Volume | Mesh] | None")
RIFFLER_TYPED(ToolLike, "Tool | collections.abc.Mapping[str, object] | str")
RIFFLER_TYPED(BudgetLike, "float | typing.Literal['auto'] | None")

RIFFLER_TYPED(Self, "typing.Self")
RIFFLER_TYPED(ToolDict, "dict[int, Tool]")
RIFFLER_TYPED(ToolDictDict, "dict[int, dict]")
RIFFLER_TYPED(StringDict, "dict[str, str]")
RIFFLER_TYPED(ArrayDict, "dict[int, numpy.typing.NDArray[numpy.float64]]")
RIFFLER_TYPED(CutList, "list[tuple[int, numpy.typing.NDArray[numpy.float64]]]")
RIFFLER_TYPED(OptionalArray, "numpy.typing.NDArray[numpy.float64] | None")
RIFFLER_TYPED(ArrayPair, "tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]")
RIFFLER_TYPED(CommandPair, "tuple[numpy.typing.NDArray[numpy.int16], numpy.typing.NDArray[numpy.float64]]")
RIFFLER_TYPED(InverseResult, "tuple[numpy.typing.NDArray[numpy.float64], list[tuple[str, str]]]")
RIFFLER_TYPED(Angles, "tuple[float, float]")
RIFFLER_TYPED(OptionalDeviation, "tuple[Mesh, numpy.typing.NDArray[numpy.float64]] | None")
RIFFLER_TYPED(VolumeAndMask, "tuple[Volume, Volume | None]")
RIFFLER_TYPED(StrokeList, "list[JournalStroke]")
RIFFLER_TYPED(OptionalGeometry, "PenGeometry | None")

RIFFLER_TYPED(WriteReport, "riffler.program_results.WriteReport")
RIFFLER_TYPED(MachineOptions, "list[riffler.program_results.MachineOption]")
RIFFLER_TYPED(MachineTextsResult, "riffler.program_results.MachineTexts")
RIFFLER_TYPED(VerifyCounters, "riffler.program_results.VerifyStats")
RIFFLER_TYPED(NearestContactResult, "riffler.program_results.NearestContact")
RIFFLER_TYPED(OptionalStock, "riffler.program_results.JournalStock | None")
RIFFLER_TYPED(TripList, "list[riffler.program_results.Trip]")
RIFFLER_TYPED(KeyChanges, "tuple[riffler.program_results.KeyChange, ...]")

RIFFLER_TYPED(LiftResult, "riffler.plan.locations.LiftReport")
RIFFLER_TYPED(LocationsResult, "tuple[numpy.typing.NDArray[numpy.float64], riffler.plan.locations.LocationReport]")
RIFFLER_TYPED(MapResults, "list[riffler.plan.orientations.MapValues]")
RIFFLER_TYPED(TiltResult, "tuple[numpy.typing.NDArray[numpy.float64], riffler.plan.orientations.TiltReport]")
RIFFLER_TYPED(PencilResult, "riffler.plan.strategies.pencil.PencilPaths")
RIFFLER_TYPED(SwarfResult, "riffler.plan.strategies.swarf.Swarf")

/// Index to axis; ValueError naming the point.
plan::OrientationKeys to_keys(const KeysLike& object);
ArrayDict from_keys(const plan::OrientationKeys& keys);
RIFFLER_TYPED(DeviceList, "list[riffler.pen_results.DeviceInfo]")
RIFFLER_TYPED(CoordinateDict, "dict[str, riffler.pen_results.CoordinateCapability]")
RIFFLER_TYPED(CapabilityResult, "riffler.pen_results.PenCapability")
RIFFLER_TYPED(HealthResult, "riffler.pen_results.PenHealth")
RIFFLER_TYPED(PriorityResult, "riffler.pen_results.ThreadPriority")
RIFFLER_TYPED(PushResult, "riffler.pen_results.PushResult")
RIFFLER_TYPED(ChannelList, "list[riffler.pen_results.PenChannel]")
RIFFLER_TYPED(LimitsResult, "riffler.pen_results.PenLimits")
RIFFLER_TYPED(DiagnosisResult, "riffler.pen_results.GripDiagnosis")

/// A result that is a dataclass of riffler.program_results, with the fields of a dict.
inline py::object program_result(const char* name, const py::dict& fields) {
  return make_result(name, fields, "riffler.program_results");
}
/// The same of the module `module`, below riffler.plan.
inline py::object plan_result(const char* module, const char* name, const py::dict& fields) {
  return make_result(name, fields, (std::string("riffler.plan.") + module).c_str());
}
/// The same of riffler.pen_results.
inline py::object pen_result(const char* name, const py::dict& fields) {
  return make_result(name, fields, "riffler.pen_results");
}

inline PriorityResult to_priority(const base::ThreadPriority& priority) {
  const char* const by[] = {nullptr, "system", "rtkit"};
  return pen_result("ThreadPriority",
                    py::dict(py::arg("level") = priority.level, py::arg("by") = by[static_cast<int>(priority.by)],
                             py::arg("text") = priority.text, py::arg("remedy") = priority.remedy));
}

}  // namespace riffler::bindings
