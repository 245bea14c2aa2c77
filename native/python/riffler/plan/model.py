"""Plans: paths and their tool."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import Mesh, PencilPath, Tool
from ..hints import hinted


@dataclass(frozen=True, eq=False)
class Plan:
    """Paths, their tool, and where they come from.

    Parameters
    ----------
    paths : list of PencilPath
        The paths.
    tool : Tool
        Cutter, shank and holder.
    cl : list, optional
        Cutter locations of every path, (n, 6), or None.
    part : dict, optional
        ``name`` and ``sha256``, as returned by ``part_of``.
    tolerance : float, optional
        Tolerance of the paths, mm.
    provenance : dict, optional
        Notes on the origin of the plan: names and texts.
    off : frozenset of int
        Numbers, from 0, of the paths that are switched off.
    depths : dict, optional
        By number of the path, from 0: depth in mm to which the cutter enters the part. The poses of these paths
        (``poses_of``) are cut unchanged, as in engraving: they are neither lifted nor oriented.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> tool = riffler.Tool.ball(diameter=4, length=20)
    >>> plan = riffler.plan.Plan(list(riffler.plan.pencil(part, tool)), tool, tolerance=0.01)
    >>> riffler.plan.save("valleys.json", plan)
    >>> len(riffler.plan.load("valleys.json").paths)
    1
    """

    paths: list[PencilPath]
    tool: Tool
    cl: list[NDArray[np.float64] | None] = field(default_factory=list)
    part: dict[str, str] = field(default_factory=dict)
    tolerance: float | None = None
    provenance: dict[str, str] = field(default_factory=dict)
    off: frozenset[int] = frozenset()
    depths: dict[int, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        _core.require_revolved(self.tool, "tool: a plan")

    @property
    def deepest(self) -> float:
        """Largest depth (mm) to which the cutter enters the part on paths that are on."""
        return max((depth for k, depth in self.depths.items() if k not in self.off), default=0.0)

    @property
    def sources(self) -> list[PencilPath]:
        """Paths from which a strategy may start: those that are on and whose poses may be changed."""
        return [path for k, path in enumerate(self.paths) if k not in self.off and k not in self.depths]


@hinted("plan.part_of")
def part_of(mesh: Mesh, name: str) -> dict[str, str]:
    """Name and hash of a part, as stored in a plan.

    Parameters
    ----------
    mesh : Mesh
        The part.
    name : str
        The part's name.

    Returns
    -------
    dict
        ``name``, and ``sha256``: the hash of vertices and triangles.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [1, 1]], size=(30, 20), depth=10)
    >>> riffler.plan.part_of(part, "plate")["name"]
    'plate'
    """
    import hashlib  # imports OpenSSL: 3 MB that only plan files need

    digest = hashlib.sha256()
    digest.update(np.ascontiguousarray(mesh.vertices, dtype="<f8").tobytes())
    digest.update(np.ascontiguousarray(mesh.triangles, dtype="<i4").tobytes())
    return {"name": str(name), "sha256": digest.hexdigest()}
