"""Long calls on a native thread that runs no Python: windows go on, and the call can be asked, cancelled or dropped.

Each function takes the arguments of the call it is named after (methods: the object first), but no ``progress``, and
returns a ``Task``; ``.result()`` is what the call returns. Arguments are checked and taken at once: what is wrong with
them is raised here or by ``.result()``. Tasks run beside each other; they share the processors.

Calls that run Python in their midst are not here: ``verify`` of an iterable of Programs, ``riffler.cluster.verify`` and
files by ``riffler.threemf``. Nor are those that change their object: ``Volume.carve``, ``add``, ``Mesher.update``.
"""

from . import plan
from ._core import Collider, Journal, Mesh, Task, Verification, Volume, verify

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


def _task_of(call, name):
    """The function that makes the call as a Task: the class in the place of a progress callback asks for that."""

    def start(*args, **kwargs) -> Task:
        return call(*args, progress=Task, **kwargs)

    start.__name__ = start.__qualname__ = call.__name__
    start.__doc__ = f"A Task of ``riffler.{name}``."
    return start


pencil = _task_of(plan.pencil, "plan.pencil")
cutter_locations = _task_of(plan.cutter_locations, "plan.cutter_locations")
kept_locations = _task_of(plan.kept_locations, "plan.kept_locations")
free_orientations = _task_of(plan.free_orientations, "plan.free_orientations")
least_tilt = _task_of(plan.least_tilt, "plan.least_tilt")
collider = _task_of(Collider.made, "Collider")
verify = _task_of(verify, "verify")
run = _task_of(Verification.run, "Verification.run")
sphere = _task_of(Volume.sphere, "Volume.sphere")
cylinder = _task_of(Volume.cylinder, "Volume.cylinder")
from_mesh = _task_of(Volume.from_mesh, "Volume.from_mesh")
parts = _task_of(Volume.parts, "Volume.parts")
grown = _task_of(Volume.grown, "Volume.grown")
resampled = _task_of(Volume.resampled, "Volume.resampled")
to_mesh = _task_of(Volume.to_mesh, "Volume.to_mesh")
to_bytes = _task_of(Volume.to_bytes, "Volume.to_bytes")
save = _task_of(Volume.save, "Volume.save")
replay = _task_of(Journal.replay, "Journal.replay")
decimate = _task_of(Mesh.decimate, "Mesh.decimate")
smooth = _task_of(Mesh.smooth, "Mesh.smooth")
deviation = _task_of(Mesh.deviation, "Mesh.deviation")
write = _task_of(Mesh.write, "Mesh.write")
