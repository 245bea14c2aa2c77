"""The older form of `riffler.submit`: functions that start a long call and return a task. Each warns once."""

from __future__ import annotations

from collections.abc import Callable

from . import plan
from ._core import Collider, Journal, Mesh, Task, Verification, Volume, verify
from .deprecated import warn
from .futures import runs_as_task

__all__ = [
    "collider",
    "cutter_locations",
    "cylinder",
    "decimate",
    "deviation",
    "free_orientations",
    "from_mesh",
    "grown",
    "kept_locations",
    "least_tilt",
    "parts",
    "pencil",
    "replay",
    "resampled",
    "run",
    "save",
    "smooth",
    "sphere",
    "to_bytes",
    "to_mesh",
    "verify",
    "write",
]

for _function in (
    plan.pencil, plan.cutter_locations, plan.kept_locations, plan.free_orientations, plan.min_tilt
):  # fmt: skip
    runs_as_task(_function)  # pyright: ignore[reportArgumentType]


def _task_of(old: str, call: Callable, name: str) -> Callable[..., Task]:
    """A function that makes the call as a Task, by passing the class Task in place of a progress callback."""

    def start(*args, **kwargs) -> Task:
        warn(f"tasks.{old}", f"riffler.submit(riffler.{name}, …)")
        return call(*args, progress=Task, **kwargs)

    start.__name__ = start.__qualname__ = old
    start.__doc__ = f"Deprecated: ``riffler.submit(riffler.{name}, …)``."
    return start


pencil = _task_of("pencil", plan.pencil, "plan.pencil")
cutter_locations = _task_of("cutter_locations", plan.cutter_locations, "plan.cutter_locations")
kept_locations = _task_of("kept_locations", plan.kept_locations, "plan.kept_locations")
free_orientations = _task_of("free_orientations", plan.free_orientations, "plan.free_orientations")
least_tilt = _task_of("least_tilt", plan.min_tilt, "plan.min_tilt")
collider = _task_of("collider", Collider.made, "Collider")
verify = _task_of("verify", verify, "verify")
run = _task_of("run", Verification.run, "Verification.run")
sphere = _task_of("sphere", Volume.sphere, "Volume.sphere")
cylinder = _task_of("cylinder", Volume.cylinder, "Volume.cylinder")
from_mesh = _task_of("from_mesh", Volume.from_mesh, "Volume.from_mesh")
parts = _task_of("parts", Volume.parts, "Volume.parts")
grown = _task_of("grown", Volume.grow, "Volume.grow")
resampled = _task_of("resampled", Volume.resample, "Volume.resample")
to_mesh = _task_of("to_mesh", Volume.to_mesh, "Volume.to_mesh")
to_bytes = _task_of("to_bytes", Volume.to_bytes, "Volume.to_bytes")
save = _task_of("save", Volume.save, "Volume.save")
replay = _task_of("replay", Journal.replay, "Journal.replay")
decimate = _task_of("decimate", Mesh.decimate, "Mesh.decimate")
smooth = _task_of("smooth", Mesh.smooth, "Mesh.smooth")
deviation = _task_of("deviation", Mesh.deviation, "Mesh.deviation")
write = _task_of("write", Mesh.write, "Mesh.write")
