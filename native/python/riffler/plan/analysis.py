"""Analysis of a part before planning."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .._core import Mesh
from ..hints import hinted
from ..mesh_notes import notes_on
from ..results import Audit


@dataclass(frozen=True, eq=False)
class PartReport(Audit):
    """Result of `analyse`: the counts of `Mesh.audit`, the repairs, and conclusions."""

    triangles: int
    """Number of triangles."""
    area: float
    """Area of the surface, mm²."""
    bounds: NDArray[np.float64]
    """(2, 3): lower and upper corner, mm."""
    closed: bool
    """No open and no non-manifold edges."""
    degenerate_share: float
    """Share of the triangles that have no area."""
    outward: bool | None
    """Whether normals point out of the material; None for open parts, for which the volume's sign means nothing."""
    turned: int
    """Triangles that were turned."""
    turned_shells: int
    """Closed pieces that faced inwards as a whole."""
    left_out: int
    """Repeated triangles that tear the surface open."""
    one_sided: int
    """Pieces with one side only."""
    units: Literal["mm", "inch", "m", "micrometre"]
    """Unit that the size suggests."""
    warnings: tuple[str, ...]
    """Sentences on problems of the part."""


@hinted("plan.analyse")
def analyse(mesh: Mesh) -> PartReport:
    """Analyses a part as plans use it, that is, after ``mesh.orient(hollow=True)``.

    Parameters
    ----------
    mesh : Mesh
        The part.

    Returns
    -------
    PartReport

    Raises
    ------
    ValueError
        For a mesh without triangles.

    Examples
    --------
    >>> report = riffler.plan.analyse(riffler.shape.relief([[1, 1], [1, 1]], size=(30, 20), depth=10))
    >>> report.closed, report.units, report.warnings
    (True, 'mm', ())
    """
    bounds = mesh.bounds
    oriented, repairs = mesh.orient_with_report(hollow=True)
    audit = oriented.audit()
    count = len(mesh.triangles)
    closed = audit.open_edges == 0 and audit.nonmanifold_edges == 0
    report = PartReport(
        **asdict(audit),
        **asdict(repairs),
        triangles=count,
        area=mesh.area,
        bounds=bounds,
        closed=closed,
        degenerate_share=audit.degenerate / count,
        outward=bool(audit.volume > 0) if closed and audit.volume != 0 else None,
        units=_units_of(float(np.max(bounds[1] - bounds[0]))),
        warnings=(),
    )
    return replace(report, warnings=tuple(_warnings(report)))


def _units_of(size: float) -> Literal["mm", "inch", "m", "micrometre"]:
    """Milled parts are about 10 mm to 2 m long; a part outside that range was probably drawn in another unit."""
    if size < 0.5:
        return "m"
    if size < 8:
        return "inch"
    return "mm" if size < 5000 else "micrometre"


def _warnings(report: PartReport) -> Iterator[str]:
    yield from notes_on(asdict(report))
    if not report.closed:
        yield (
            f"the part is not closed: {report.open_edges} open and "
            f"{report.nonmanifold_edges} non-manifold edges; paths end at open ones"
        )
    if report.outward is False:
        yield "the normals point into the material: valleys are looked for on the wrong side"
    if report.degenerate:
        yield f"{report.degenerate} of {report.triangles} triangles have no area; they are used as lines"
    if report.units != "mm":
        size = float(np.max(report.bounds[1] - report.bounds[0]))
        yield f"the largest side is {size:g}: lengths are taken as mm, but it looks like {report.units}"
