"""Results of several values: frozen dataclasses with typed attributes, and named tuples.

Results that were dicts can still be read as dicts, with a DeprecationWarning (`riffler.deprecated.DictResult`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .deprecated import DictResult, warn

if TYPE_CHECKING:
    from ._core import Tool, Volume

__all__ = [
    "Audit",
    "HistoryStats",
    "HistoryStroke",
    "Hit",
    "Hits",
    "Nearest",
    "Orientation",
    "Patch",
    "PickCounters",
    "SurfaceReport",
    "VolumeCounters",
    "VolumeReport",
]

Corner = tuple[float, float, float]


@dataclass(frozen=True)
class Audit(DictResult):
    """Defects of a mesh, counted by `Mesh.audit`; all but the last two are 0 for a closed two-manifold."""

    open_edges: int
    """Edges of one triangle."""
    nonmanifold_edges: int
    """Edges of three triangles or more, or of two that run it in the same direction."""
    nonmanifold_vertices: int
    """Vertices whose triangles are not one fan."""
    degenerate: int
    """Triangles with a vertex twice, or of area exactly 0."""
    duplicates: int
    """Triangles with the vertices of an earlier one."""
    folds: int
    """Edges whose two triangles lie on each other."""
    components: int
    """Pieces connected across edges."""
    volume: float
    """Signed volume, mm³."""


@dataclass(frozen=True)
class Orientation(DictResult):
    """Changes that `Mesh.orient_with_report` has made."""

    turned: int
    """Triangles that were turned."""
    turned_shells: int
    """Closed pieces that faced inwards as a whole."""
    left_out: int
    """Repeated triangles that tear the surface open; in the result they name one vertex three times."""
    one_sided: int
    """Pieces with one side only, like a Möbius strip."""


@dataclass(frozen=True)
class LostReport(DictResult):
    """Material that is not part of a volume's mesh because it is thinner than the pitch."""

    lost: float
    """Volume of the material, mm³."""
    lost_box: tuple[Corner, Corner] | None
    """Box of the material, mm: lower and upper corner."""
    lost_pitch: float | None
    """A pitch that keeps the material, mm."""
    lost_note: str
    """A sentence if more than crumbs are lost, otherwise empty."""


@dataclass(frozen=True)
class SurfaceReport(LostReport):
    """Report of `Volume.to_mesh_with_report`: material that the mesh lacks, and the mesh's size without a tolerance."""

    all_triangles: int
    """Triangles without a tolerance."""


@dataclass(frozen=True)
class VolumeReport(LostReport):
    """Report of `Volume.from_mesh_with_report`: faults of the mesh, and material that rays or a later mesh miss."""

    triangles: int
    """All triangles of the mesh."""
    degenerate: int
    """Triangles without area."""
    duplicates: int
    """Repeated triangles."""
    open_edges: int
    """Edges of one triangle."""
    nonmanifold_edges: int
    """Edges of three triangles or more."""
    inconsistent_edges: int
    """Edges of two triangles that run it in the same direction."""
    openings: int
    """Boundary loops, along which the surface ends."""
    turned: int
    """Triangles that were turned to agree with their neighbours."""
    left_out: int
    """Repeated triangles that tear the surface open."""
    one_sided: int
    """Pieces with one side only, like a Möbius strip."""
    flipped_shells: int
    """Shells that face into the material."""
    inside_out: float
    """Share of the volume where the winding number is negative."""
    overlap: float
    """Share of the volume where the winding number is 2 or more."""
    doubtful_rays: float
    """Share of the rays with material that end within an opening instead of on the surface."""


@dataclass(frozen=True)
class VolumeCounters(DictResult):
    """The work done on a volume: `Volume.counters`."""

    moves: int
    """Moves carved."""
    steps: int
    """Steps that the moves were split into, summed over the tool's pieces."""
    tiles_visited: int
    """(tile, move) pairs whose rays were tested."""
    tiles_changed: int
    """Tiles written."""
    rays_tested: int
    """(ray, step) pairs intersected with a swept piece."""
    hits: int
    """(ray, pose) intersections computed for these pairs."""
    rays_changed: int
    """Tested rays that lost material."""
    tiles_meshed: int
    """Tiles turned into triangles."""
    triangles_tested: int
    """Triangles tested against rays or tools."""
    bytes_copied: int
    """Bytes of tiles copied when they were written."""


@dataclass(frozen=True, eq=False)
class HistoryStroke:
    """A stroke of a history: `History.stroke`.

    Examples
    --------
    >>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
    >>> k = history.add(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]], mode="add")
    >>> stroke = history.stroke(k)
    >>> stroke.mode, stroke.tolerance, stroke.enabled
    ('add', 0.01, True)
    """

    id: int
    """Id of the stroke."""
    tool: Tool
    """The tool whose cutter is swept."""
    poses: NDArray[np.float64]
    """(n, 6): tip in mm, unit axis; (n, 9) for a hand tool, with its forward direction."""
    mode: str
    """"remove" or "add"."""
    tolerance: float
    """Largest error of carving, mm."""
    protect: Volume | None
    """Region that the stroke leaves unchanged; None if there is none."""
    enabled: bool
    """Whether the stroke is carved."""


@dataclass(frozen=True)
class HistoryStats:
    """The work of a history's last edit, and its size: `History.stats`.

    Examples
    --------
    >>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
    >>> k = history.add(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
    >>> history.stats().strokes, history.stats().tiles_restored
    (1, 0)
    """

    edits: int
    """Edits that succeeded so far."""
    tiles_restored: int
    """Tiles that the last edit restored to an earlier version."""
    strokes_run: int
    """Strokes that the last edit carved, the new one included."""
    tiles_run: int
    """(stroke, tile) pairs that the last edit carved."""
    moves_run: int
    """(move, block of 4 × 4 tiles) pairs that the last edit carved."""
    tiles_changed: int
    """Tiles of the volume that the last edit replaced."""
    strokes: int
    """Strokes in the history, disabled ones included."""
    versions: int
    """Versions of tiles that the history holds."""
    version_bytes: int
    """Bytes of these versions."""
    stroke_bytes: int
    """Bytes of poses and of the lists of touched tiles."""
    stride: int
    """Strokes on a tile between two versions that the history holds."""


@dataclass(frozen=True)
class PickCounters(DictResult):
    """The work of picking: `Mesher.counters`."""

    rays: int
    """Picked rays."""
    bricks_visited: int
    """Bricks that the rays passed."""
    bricks_prepared: int
    """Bricks that had changed and so were prepared first."""
    triangles_tested: int
    """Triangles tested against rays."""


@dataclass(frozen=True, eq=False)
class Patch:
    """The triangles of one or more bricks. See `Mesher.patch`."""

    vertices: NDArray[np.float32]
    """(n, 3) mm."""
    triangles: NDArray[np.int32]
    """(k, 3): indices of vertices."""
    edges: NDArray[np.int32] | None = None
    """(e, 2): indices of vertices, each edge once. None unless requested."""
    corner_edges: NDArray[np.int32] | None = None
    """(k, 3): for each corner of each triangle, the edge to the next corner. None unless requested."""
    normals: NDArray[np.float32] | None = None
    """(3 k, 3): unit normals of the triangles' corners. None unless requested."""

    def _as_tuple(self) -> tuple[NDArray, ...]:
        warn("Patch as a tuple", "its attributes: vertices, triangles, edges, corner_edges, normals")
        arrays = (self.vertices, self.triangles, self.edges, self.corner_edges, self.normals)
        return tuple(a for a in arrays if a is not None)

    def __iter__(self) -> Iterator[NDArray]:
        return iter(self._as_tuple())

    def __getitem__(self, index: int) -> NDArray:
        return self._as_tuple()[index]

    def __len__(self) -> int:
        return len(self._as_tuple())


class Hit(NamedTuple):
    """Where a ray meets the surface: `Mesher.pick`."""

    distance: float
    """mm from the ray's origin."""
    point: NDArray[np.float64]
    """(3,) mm."""
    normal: NDArray[np.float64]
    """(3,): unit normal of the triangle, out of the material, so along a ray that comes from inside."""
    brick: int
    """Number of the brick."""


class Hits(NamedTuple):
    """Where n rays meet the surface: `Mesher.pick`."""

    distance: NDArray[np.float64]
    """(n,) mm from the ray's origin; inf where nothing is hit."""
    point: NDArray[np.float64]
    """(n, 3) mm; NaN where nothing is hit."""
    normal: NDArray[np.float64]
    """(n, 3): unit normal of the triangle, out of the material; NaN where nothing is hit."""
    brick: NDArray[np.int64]
    """(n,): number of the brick; -1 where nothing is hit."""


class Nearest(NamedTuple):
    """The point of part and fixtures nearest to a tool: `Collider.nearest`."""

    distance: float
    """mm; negative if they overlap."""
    point: NDArray[np.float64]
    """(3,) mm, on part or fixture."""
    part: str
    """The nearest part of the tool: "cutter", "shank" or "holder"; or "fixture"."""
