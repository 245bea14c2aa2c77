"""Riffler: sculpt with a pen as if milling, plan five-axis pencil cuts, take STL and NC code away.

Lengths in mm, angles in rad, times in s, forces in N. The names below are the public API; ``riffler._core`` is not.
"""

from . import cluster, pen, plan
from ._core import (
    Cancelled,
    Collider,
    Contact,
    Cut,
    Finding,
    FormatError,
    Journal,
    JournalStroke,
    JournalWriter,
    Mesh,
    Mesher,
    Program,
    Snapshot,
    Tool,
    Verification,
    VerifyReport,
    Volume,
    __version__,
    machines,
    verify,
)

__all__ = [
    "Cancelled",
    "Collider",
    "Contact",
    "Cut",
    "Finding",
    "FormatError",
    "Journal",
    "JournalStroke",
    "JournalWriter",
    "Mesh",
    "Mesher",
    "Program",
    "Snapshot",
    "Tool",
    "Verification",
    "VerifyReport",
    "Volume",
    "__version__",
    "cluster",
    "machines",
    "pen",
    "plan",
    "verify",
]
