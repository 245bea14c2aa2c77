"""Riffler: sculpt with a pen as if milling, plan five-axis pencil cuts, take STL and NC code away.

Lengths in mm, angles in rad, times in s, forces in N. The names below are the public API; ``riffler._core`` is not.
"""

from typing import TYPE_CHECKING

from . import _core, cluster, deprecated, old, pen, plan, shape, tasks
from ._core import (
    Cancelled,
    Collider,
    Contact,
    Cut,
    Finding,
    FormatError,
    FrozenSurface,
    Journal,
    JournalStroke,
    JournalWriter,
    Material,
    Mesh,
    Mesher,
    Program,
    Session,
    SessionFrame,
    Snapshot,
    Softened,
    Task,
    Tool,
    ToolShape,
    ToolSize,
    Verification,
    VerifyReport,
    Volume,
    __version__,
    machine_options,
    machines,
    set_threads,
    threads,
    verify,
)

__all__ = [
    "Cancelled",
    "Collider",
    "Contact",
    "Cut",
    "Finding",
    "FormatError",
    "FrozenSurface",
    "Journal",
    "JournalStroke",
    "JournalWriter",
    "Material",
    "Mesh",
    "Mesher",
    "Program",
    "Session",
    "SessionFrame",
    "Snapshot",
    "Softened",
    "Task",
    "Tool",
    "ToolShape",
    "ToolSize",
    "Verification",
    "VerifyReport",
    "Volume",
    "__version__",
    "cluster",
    "machine_options",
    "machines",
    "pen",
    "plan",
    "set_threads",
    "shape",
    "tasks",
    "threads",
    "verify",
]

deprecated.install(old.ALL.attributes, vars(plan) | vars(pen) | vars(_core) | globals())
if not TYPE_CHECKING:
    __getattr__ = deprecated.module_getattr("riffler", old.ALL.modules.get("", {}))
